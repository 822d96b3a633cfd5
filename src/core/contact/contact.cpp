#include "contact/contact.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#define SKISNOW_LANES alone
#include "contact/force_kernels.hpp"

namespace skisnow {

namespace {

// Loads of the sections on the nodes of a beam, by Hermite's shapes.
void load_beam(const Runner& runner, const Sections& s, std::vector<double>& beam) {
  beam.assign(std::size_t(3 * runner.nodes()), 0.0);
  for (int i = 0; i < s.count(); i++) {
    if (!s.touches(i)) continue;
    const double z = s[IN_ELEMENT][i], h = s[ELEMENT_LENGTH][i], y = 1.0 - z, force = s[BEAM_FORCE][i];
    double* node = beam.data() + 3 * int(s[ELEMENT][i]);
    node[0] += y * y * (1.0 + 2.0 * z) * force;
    node[1] += h * z * y * y * force;
    node[2] += y * s[BEAM_MOMENT][i];
    node[3] += z * z * (3.0 - 2.0 * z) * force;
    node[4] += -h * z * z * y * force;
    node[5] += z * s[BEAM_MOMENT][i];
  }
}

// [strengthen] Strength and thrust of the sections by the edge's angle.
void strengthen(const ShearLaw& law, Sections& s) {
  for (int i = 0; i < s.count(); i++) {
    if (!s.touches(i)) continue;
    const double angle = s.base.face_angle(i), strength = s[EDGE_STRENGTH][i];
    if (law.cuts) {
      const double cotangent = 1.0 / std::tan(std::max(0.5 * (angle - law.friction_angle), law.least_plane));
      s.edge[EDGE_STRENGTH][i] = 2.0 * cotangent * strength;
      s.edge[EDGE_THRUST][i] = (cotangent * cotangent - 1.0) * strength;
    } else {
      s.edge[EDGE_STRENGTH][i] = (1.0 - law.decrease * angle) * strength;
    }
  }
}

// μ of the law at the place of each line.
void share_friction(const GrooveLines& lines, Sections& s) {
  for (int i = 0; i < s.count(); i++) {
    const double share = s.touches(i) ? lines.values[FRICTION][lines.slot(s.line(i))] : 0.0;
    s.sliding[MU][i] *= share, s.sliding[MU_GROWTH][i] *= share;
  }
}

// [ease] Strength and thrust are known: the displacement of each edge, and by how much they have eased it.
void ease(const Snow& snow, const GrooveLines& lines, Sections& s) {
  for (int i = 0; i < s.count(); i++)
    for (int k = 0; k < 2 && s.touches(i); k++) {
      double& used = s.edge[of_edge(LEFT_USED, k)][i];
      const double depth = s[of_edge(LEFT_DEPTH, k)][i], before = used;
      if (!(depth > 0.0)) continue;
      used = alone::eased<double>(snow, lines, lines.slot(s.line(i)), k, before, s[EDGE_STRENGTH][i], s[EDGE_THRUST][i],
                                  depth);
      s.edge[of_edge(LEFT_EASED, k)][i] = used - before;
    }
}

// The same situation with one runner moved, or its motion changed, by a small step of one of its six freedoms.
Situation displaced(const Situation& at, int k, int freedom, double step, bool of_motion) {
  Situation out = at;
  const auto which = std::size_t(freedom % 3);
  if (of_motion) {
    Motion& motion = out.motions[std::size_t(k)];
    (freedom < 3 ? motion.velocity : motion.turning)[which] += step;
    return out;
  }
  Pose& pose = out.poses[std::size_t(k)];
  if (freedom < 3) {
    pose.position[which] += step;
    return out;
  }
  const std::size_t a = (which + 1) % 3, b = (which + 2) % 3;
  for (int c = 0; c < 3; c++) {
    const double first = pose.rotation[a][c], second = pose.rotation[b][c];
    pose.rotation[a][c] = std::cos(step) * first - std::sin(step) * second;
    pose.rotation[b][c] = std::sin(step) * first + std::cos(step) * second;
  }
  return out;
}

constexpr double LEVEL = 1e-6;         // sine of the roll of a base that is level
constexpr double TANGENT_STEP = 1e-8;  // m, rad
constexpr double POSE_STEP = 1e-7;     // m, rad
constexpr double MOTION_STEP = 1e-4;   // m/s, rad/s

}  // namespace

Situation situation_of(const double* position, const double* rotation, const double* velocity, double dt,
                       std::vector<std::vector<double>> beams, std::vector<std::vector<double>> rates) {
  Situation out{std::vector<Pose>(beams.size()), std::vector<Motion>(beams.size()), dt};
  for (std::size_t k = 0; k < beams.size(); k++) {
    Pose& pose = out.poses[k];
    pose.position = vector_at(position + 3 * k);
    std::copy_n(rotation + 9 * k, 9, &pose.rotation[0][0]);
    if (velocity != nullptr) out.motions[k] = {vector_at(velocity + 6 * k), vector_at(velocity + 6 * k + 3), {}};
    pose.beam = std::move(beams[k]), out.motions[k].beam = std::move(rates[k]);
  }
  return out;
}

SnowContact::SnowContact(std::shared_ptr<Snow> snow, std::vector<Runner> runners, double spacing,
                         const Kernels& kernels)
    : snow_(std::move(snow)), runners_(std::move(runners)), kernels_(&kernels) {
  for (const Runner& each : runners_) {
    state_.lines.emplace_back(each, spacing);
    state_.strips.push_back(snow_->archive.new_strip());
  }
  trial_ = state_.lines;
  std::size_t slots = 0;
  for (const GrooveLines& each : state_.lines) slots = std::max(slots, std::size_t(each.capacity()));
  for (Column* each : {&scratch_, &is_needed_}) each->resize(slots);
  before_.resize(runners_.size());
  for (const GrooveLines& each : state_.lines) sections_.emplace_back(each.capacity());
  if (snow_->rate.acts()) rated_.resize(runners_.size());
  state_.time = snow_->archive.time;
  wrenches_.resize(runners_.size());
}

void SnowContact::set_penetration(PenetrationLaw law) {
  bearing_ = std::make_shared<Bearing>(std::move(law));
  for (GrooveLines& each : state_.lines)
    each.lost = [bearing = bearing_](const Ground& ground) { return bearing->lost(ground); };
}

const Wrench& SnowContact::evaluate(int k, const GrooveLines& lines, const Pose& pose, const Motion& motion, bool grows,
                                    Sections& s) {
  kernels_->find_sections(runner(k), pose, lines, nullptr, s.base);
  kernels_->press(*snow_, lines, s.base, grows, s.pressure, s.edge);
  if (bearing_) bearing_->press(lines, s);
  if (!rated_.empty()) rated_[std::size_t(k)].press(*snow_, lines, pose, motion, dt_, s);
  kernels_->slide(motion, pose, dt_, *snow_, lines, s.base, s.pressure, s.sliding);
  if (snow_->shear.by_angle()) strengthen(snow_->shear, s);
  if (laws) laws(k, s);
  if (!snow_->friction_share.is_constant()) share_friction(lines, s);
  if (strength_varies()) ease(*snow_, lines, s);
  Wrench& wrench = wrenches_[std::size_t(k)];
  kernels_->push(*snow_, s.base, s.pressure, s.edge, s.sliding, s.forces, wrench);
  return wrench;
}

Reaction SnowContact::reaction(int k, const GrooveLines& lines, const Pose& pose, const Motion& motion) {
  Sections& s = sections_[std::size_t(k)];
  const Wrench& wrench = evaluate(k, lines, pose, motion, false, s);
  Reaction out;
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++) {
      out.force[a] += pose.rotation[a][b] * wrench.force[b];
      out.moment[a] += pose.rotation[a][b] * wrench.moment[b];
    }
  if (!pose.beam.empty()) load_beam(runner(k), s, out.beam);
  return out;
}

const Wrench& SnowContact::look(int k, const Pose& pose, const Motion& motion, bool with_tangent) {
  Sections& s = sections_[std::size_t(k)];
  const Wrench& wrench = evaluate(k, lines(k), pose, motion, with_tangent, s);
  load_beam(runner(k), s, wrenches_[std::size_t(k)].beam);
  return wrench;
}

// Derivatives of the sections; of a base whose law comes from outside or takes time all by differences.
void SnowContact::differ(int k, double sense, bool is_level) {
  const Sections& s = sections(k);
  differences_.resize(s.count());
  if (!bearing_ && rated_.empty())
    return kernels_->differ(*snow_, lines(k), s, TANGENT_STEP, sense, is_level, differences_);
  const auto differ = [&](double way) {
    if (bearing_)
      bearing_->differ(*snow_, lines(k), s, TANGENT_STEP, way, differences_);
    else
      rated_[std::size_t(k)].differ(*snow_, lines(k), s, TANGENT_STEP, way, differences_);
  };
  differ(sense);
  if (!is_level) return;
  const std::vector<double> one = differences_.values;
  differ(-sense);
  for (std::size_t i = 0; i < one.size(); i++) differences_.values[i] = 0.5 * (one[i] + differences_.values[i]);
}

void SnowContact::find_tangent(int k, const Pose& pose, double stiffness, double damping, RunnerTangent& out) {
  const Sections& s = sections(k);
  const bool bends = runner(k).nodes() > 2;
  const double lean = pose.rotation[2][1], sense = lean < 0.0 ? -1.0 : 1.0;  // in the mirror the other way
  out.clear(runner(k).nodes());
  differ(k, sense, std::fabs(lean) < LEVEL);  // a level base has two tangents: between them
  kernels_->add_stiffness(s, differences_, stiffness, stiffness, std::max(damping, 0.0), bends, out);
  out.add_turning(wrenches_[std::size_t(k)], stiffness);
  if (!(damping > 0.0 && snow_->rate.damping > 0.0)) return;
  rated_[std::size_t(k)].differ_rates(*snow_, lines(k), s, sense, differences_);
  kernels_->add_stiffness(s, differences_, damping, 0.0, 0.0, bends, out);
}

// The lines at the end of a step, before its end is remembered: those that stand, or where that changes them a copy.
GrooveLines& SnowContact::history(int k, const Situation& at) {
  GrooveLines& standing = state_.lines[std::size_t(k)];
  const Pose& pose = at.poses[std::size_t(k)];
  const bool marches = !state_.accepted.empty() && parts(k, at) > 1;
  const bool reaches = standing.count() > 0 && standing.station(standing.end - 1, pose) > runner(k).tip &&
                       standing.station(standing.first, pose) < runner(k).tail;
  if (!marches && reaches) return standing;
  GrooveLines& trial = trial_[std::size_t(k)];
  trial = standing;
  trial.drop_left(runner(k), pose, nullptr, 0);
  prepare(k, trial, pose);
  march(k, trial, at);
  return trial;
}

std::vector<Reaction> SnowContact::force(const Situation& at) {
  std::vector<Reaction> out;
  dt_ = at.dt;
  for (int k = 0; k < runners(); k++)
    out.push_back(reaction(k, history(k, at), at.poses[std::size_t(k)], at.motions[std::size_t(k)]));
  return out;
}

void SnowContact::begin(const Situation& foreseen) {
  take_back();
  dt_ = foreseen.dt;
  for (int k = 0; k < runners(); k++) {
    GrooveLines& lines = state_.lines[std::size_t(k)];
    Before& before = before_[std::size_t(k)];
    before.first = lines.first, before.end = lines.end;
    before.lines.clear();
    if (!is_clear(k, foreseen)) prepare(k, lines, foreseen.poses[std::size_t(k)]);
  }
  for (int k = 0; k < runners(); k++) march_where_needed(k, foreseen);
  begun_ = true;
}

void SnowContact::take_back() {
  for (std::size_t k = 0; begun_ && k < before_.size(); k++) before_[k].put_back(state_.lines[k]);
  begun_ = false;
}

void SnowContact::weigh_unseen() {
  double most = 0.0;  // of pressure and shear for each metre of ski
  for (const Sections& s : sections_)
    for (int i = 0; i < s.count(); i++)
      if (s.touches(i)) most = std::max(most, std::hypot(s[FORCE][i], s[SHEAR][i]) / s[SHARE][i]);
  unseen_force_ = std::max(unseen_force_, most * unseen_width_);
}

void SnowContact::accept(const Situation& at) {
  begun_ = false;
  if (unseen_width_ > 0.0) weigh_unseen();
  pass_time(at.dt);
  for (int k = 0; k < runners(); k++) settle_history(k, at);
  stand(at);
}

void SnowContact::pass_time(double dt) {
  dt_ = dt;
  state_.time += dt;
  snow_->archive.time = std::max(snow_->archive.time, state_.time);
}

void SnowContact::update(const Situation& to) {
  pass_time(to.dt);
  for (int k = 0; k < runners(); k++) {
    GrooveLines& lines = state_.lines[std::size_t(k)];
    lines.drop_left(runner(k), to.poses[std::size_t(k)], &snow_->archive, state_.strips[std::size_t(k)]);
    prepare(k, lines, to.poses[std::size_t(k)]);
  }
  for (int k = 0; k < runners(); k++) {
    GrooveLines& lines = state_.lines[std::size_t(k)];
    const Pose& pose = to.poses[std::size_t(k)];
    march(k, lines, to);
    if (strength_varies())
      evaluate(k, lines, pose, to.motions[std::size_t(k)], false, sections_[std::size_t(k)]);
    else
      kernels_->find_sections(runner(k), pose, lines, nullptr, sections_[std::size_t(k)].base);
    settle_history(k, to);
  }
  stand(to);
}

void SnowContact::stand(const Situation& at) {
  for (int k = 0; k < runners(); k++)
    if (!is_clear(k, at)) prepare(k, state_.lines[std::size_t(k)], at.poses[std::size_t(k)]);
  state_.accepted = at.poses;
}

void SnowContact::tangent(const Situation& at, std::vector<double>& stiffness, std::vector<double>& damping) {
  const auto size = std::size_t(36 * runners());
  dt_ = at.dt;
  stiffness.assign(size, 0.0);
  damping.assign(size, 0.0);
  for (int k = 0; k < runners(); k++)
    for (int freedom = 0; freedom < 12; freedom++) {
      const bool of_motion = freedom >= 6;
      const double step = of_motion ? MOTION_STEP : POSE_STEP;
      Reaction side[2];
      for (int way = 0; way < 2; way++) {
        const Situation moved = displaced(at, k, freedom % 6, way == 0 ? step : -step, of_motion);
        side[way] = reaction(k, history(k, moved), moved.poses[std::size_t(k)], moved.motions[std::size_t(k)]);
      }
      std::vector<double>& out = of_motion ? damping : stiffness;
      for (int a = 0; a < 3; a++) {
        const auto row = std::size_t(36 * k + 6 * a + freedom % 6);
        out[row] = -(side[0].force[a] - side[1].force[a]) / (2.0 * step);
        out[row + 18] = -(side[0].moment[a] - side[1].moment[a]) / (2.0 * step);
      }
    }
}

ContactPower SnowContact::power(int k, const Pose& pose, const Motion& motion) const {
  const Wrench& wrench = wrenches_[std::size_t(k)];
  ContactPower out = kernels_->sum_power(motion, pose, sections(k));
  double all = 0.0;
  for (std::size_t a = 0; a < 3; a++)
    for (std::size_t b = 0; b < 3; b++)
      all += pose.rotation[b][a] * (wrench.force[a] * motion.velocity[b] + wrench.moment[a] * motion.turning[b]);
  for (std::size_t i = 0; i < motion.beam.size(); i++) all += wrench.beam[i] * motion.beam[i];
  out.normal = all - out.shear - out.friction;
  return out;
}

bool SnowContact::touches(int k) const {
  const Sections& s = sections(k);
  for (int i = 0; i < s.count(); i++)
    if (s.touches(i)) return true;
  return false;
}

double SnowContact::groove_energy() const {
  double total = snow_->archive.energy();
  for (const GrooveLines& each : state_.lines) total += each.groove_energy();
  return total;
}

double SnowContact::held_energy() const {
  double total = 0.0;
  for (const Sections& s : sections_)
    for (int i = 0; i < s.count(); i++) {
      if (!s.touches(i)) continue;
      for (int k = 0; k < 2; k++)
        total += 0.5 * snow_->shear_displacement * s[of_edge(LEFT_SHEAR, k)][i] *
                 std::clamp(s[of_edge(LEFT_USED, k)][i], -1.0, 1.0);
    }
  return total;
}

double SnowContact::stuck_energy() const {
  double total = 0.0;
  for (const Sections& s : sections_)
    for (int i = 0; i < s.count(); i++) {
      if (!s.touches(i) || s[RUB_BY_WAY][i] == 0.0) continue;
      const double square = s[RUB][i] * s[RUB][i] + s[RUB_ASIDE][i] * s[RUB_ASIDE][i];
      total += 0.5 * snow_->friction.stick * s[MU][i] * s[FRICTION_LOAD][i] * square;
    }
  return total;
}

double SnowContact::elastic_energy() const {
  double total = 0.0;
  for (const Sections& s : sections_)
    for (int i = 0; i < s.count(); i++) total += s[SNOW_ENERGY][i];
  return total;
}

double SnowContact::delayed_stored() const {
  if (!snow_->rate.is_delayed()) return 0.0;
  double total = 0.0;
  for (const GrooveLines& each : state_.lines)
    for (std::int64_t n = each.first; n < each.end; n++) {
      const DelayedGround& delayed = each.delayed[std::size_t(each.slot(n))];
      const double spring = each.values[HARDNESS][each.slot(n)] / snow_->rate.delayed_share;  // H₂
      for (const double depth : delayed.depth) total += 0.5 * spring * depth * depth * delayed.spacing * each.spacing();
    }
  return total;
}

// Whether the strength of an edge may rise while it holds.
bool SnowContact::strength_varies() const {
  return snow_->shear.by_angle() || laws || bearing_ || !snow_->strength.is_constant() || snow_->strength_share != 1.0;
}

SnowContact::State SnowContact::state() const {
  State out = state_;
  out.tracks = snow_->archive.mark();
  return out;
}

void SnowContact::restore(const State& state) {
  snow_->archive.forget_since(state.tracks);
  state_ = state;
}

}  // namespace skisnow
