#include "fmi/fmu_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace skisnow {

namespace {

constexpr int POSE = 7, MOTION = 6, WRENCH = 6;  // place and quaternion; velocities; force and moment
constexpr int SNOW_PARAMETERS = 4;               // hardness, failure shear stress, unloading ratio, friction
constexpr double SAME_TIME = 1e-9;               // share of a time by which a step may begin beside the last one's end
constexpr double UNIT = 1e-2;                    // by which a quaternion's length may differ from 1

void require(bool good, const std::string& what) {
  if (!good) throw std::invalid_argument(what);
}

// Axes as columns, from a quaternion w, x, y, z of about the length 1.
void take_quaternion(const double* from, double (&out)[3][3]) {
  const double length = std::sqrt(from[0] * from[0] + from[1] * from[1] + from[2] * from[2] + from[3] * from[3]);
  require(std::fabs(length - 1.0) < UNIT, "a quaternion has the length " + std::to_string(length) + "; it must be 1");
  const double w = from[0] / length, x = from[1] / length, y = from[2] / length, z = from[3] / length;
  const double rows[3][3] = {{1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)},
                             {2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)},
                             {2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)}};
  std::copy(&rows[0][0], &rows[0][0] + 9, &out[0][0]);
}

// The quaternion of a rotation, of its two the one nearer to `last`: w, x, y, z.
void put_quaternion(const double (&m)[3][3], double* last) {
  const double square[4] = {1.0 + m[0][0] + m[1][1] + m[2][2], 1.0 + m[0][0] - m[1][1] - m[2][2],
                            1.0 - m[0][0] + m[1][1] - m[2][2], 1.0 - m[0][0] - m[1][1] + m[2][2]};
  const double rest[4][4] = {{0.0, m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1]},
                             {m[2][1] - m[1][2], 0.0, m[1][0] + m[0][1], m[0][2] + m[2][0]},
                             {m[0][2] - m[2][0], m[1][0] + m[0][1], 0.0, m[2][1] + m[1][2]},
                             {m[1][0] - m[0][1], m[0][2] + m[2][0], m[2][1] + m[1][2], 0.0}};
  const auto most = std::max_element(square, square + 4) - square;
  const double twice = std::sqrt(square[most]);  // of its largest number
  double found[4], along = 0.0;
  for (int i = 0; i < 4; i++) {
    found[i] = i == most ? 0.5 * twice : 0.5 * rest[most][i] / twice;
    along += found[i] * last[i];
  }
  for (int i = 0; i < 4; i++) last[i] = along < 0.0 ? -found[i] : found[i];
}

SnowContact contact_of(const std::shared_ptr<Snow>& snow, const Fields& data) {
  return SnowContact(snow, runners_of(data), data.number("spacing"), kernels());
}

}  // namespace

std::unique_ptr<FmuModel> FmuModel::of(const Fields& data) {
  if (data.whole("kind") == 0) return std::make_unique<FmuContact>(data);
  return std::make_unique<FmuSledge>(data);
}

void FmuModel::take_counts(const Fields& data, int own_parameters, int own_inputs, int outputs) {
  parameters = own_parameters, inputs = own_inputs;
  values = start_ = data.at("start", std::size_t(1 + parameters + inputs + outputs));
}

FmuContact::FmuContact(const Fields& data)
    : snow_(snow_of(data)), runners_(runners_of(data)), spacing_(data.number("spacing")) {
  const int count = int(runners_.size());
  take_counts(data, SNOW_PARAMETERS, (POSE + MOTION) * count, WRENCH * count);
}

std::unique_ptr<FmuModel> FmuContact::copy() const {
  auto out = std::make_unique<FmuContact>(*this);
  out->snow_ = std::make_shared<Snow>(*snow_);
  if (contact_) out->contact_->set_snow(out->snow_);
  return out;
}

// Those that differ from what the data have, which may vary over the place.
void FmuContact::take_parameters() {
  const double *given = parameter(), *usual = start_.data() + 1;
  require(given[0] > 0.0, "snow.hardness must be above 0");
  require(given[1] >= 0.0, "snow.failure_shear_stress must be at least 0");
  require(given[2] >= 1.0, "snow.unloading_ratio must be at least 1");
  require(given[3] >= 0.0, "snow.friction must be at least 0");
  if (given[0] != usual[0]) snow_->hardness = Grid(given[0]);
  if (given[1] != usual[1]) snow_->strength = Grid(given[1]);
  snow_->unloading_ratio = given[2], snow_->friction.constant = given[3];
}

Situation FmuContact::situation(double time) {
  Situation out;
  out.dt = std::max(0.0, time - accepted_);
  const double* from = input();
  for (std::size_t k = 0; k < runners_.size(); k++) {
    Pose pose{vector_at(from)};
    take_quaternion(from + 3, pose.rotation);
    out.poses.push_back(std::move(pose));
    out.motions.push_back({vector_at(from + POSE), vector_at(from + POSE + 3), {}});
    from += POSE + MOTION;
  }
  return out;
}

void FmuContact::meet(double time) {
  const Situation at = situation(time);
  if (!contact_) return;  // no contact before begin()
  auto& contact = *contact_;
  double* to = output();
  for (const Reaction& each : contact.force(at)) to = std::copy_n(each.moment, 3, std::copy_n(each.force, 3, to));
  contact.update(at);
  accepted_ = time;
}

void FmuContact::begin(double time) {
  take_parameters();
  contact_.emplace(snow_, runners_, spacing_, skisnow::kernels());
  accepted_ = values[0] = time;
  meet(time);
}

void FmuContact::step(double from, double to) {
  meet(from);
  values[0] = to;
}

void FmuContact::write(ByteWriter& out) const {
  out.all(values), out.number(accepted_);
  out.whole(contact_ ? 1 : 0);
  if (contact_) contact_->write(contact_->state(), out);
}

void FmuContact::read(ByteReader& in) {
  in.all(values), accepted_ = in.number();
  if (in.whole(0, 1) == 0) return;
  take_parameters();
  contact_.emplace(snow_, runners_, spacing_, skisnow::kernels());
  contact_->take(contact_->read(in));
}

FmuSledge::FmuSledge(const Fields& data)
    : snow_(snow_of(data)),
      contact_(contact_of(snow_, data)),
      dynamics_(body_of(data), contact_, rule_of(data)),
      at_rest_(data.number("at_rest")) {
  const auto& place = data.at("pose", 12);
  std::copy_n(place.begin(), 3, dynamics_.state.position.begin());
  std::copy_n(place.begin() + 3, 9, &dynamics_.state.rotation[0][0]);
  dynamics_.set_skis(data.at("inertia", dynamics_.body().skis.size() * BODY * BODY));
  boots_.resize(std::size_t(data.whole("moving")));
  take_counts(data, 1, 6 + (POSE + MOTION) * int(boots_.size()), POSE + MOTION + WRENCH * contact_.runners());
}

std::unique_ptr<FmuModel> FmuSledge::copy() const {
  auto out = std::make_unique<FmuSledge>(*this);
  out->contact_.set_snow(out->snow_ = std::make_shared<Snow>(*snow_));
  out->dynamics_.set_contact(out->contact_);
  return out;
}

void FmuSledge::push() { dynamics_.set_push(vector_at(input()), vector_at(input() + 3)); }

// From where the boots are, or at rest, to the inputs.
void FmuSledge::move_boots(double from, double to, bool at_rest) {
  std::vector<BootMotion> motions;
  const double* given = input() + 6;
  for (BootPose& now : boots_) {
    double axes[3][3];
    take_quaternion(given + 3, axes);
    BootPose next{vector_at(given), {}, {}, {}, vector_at(given + POSE), vector_at(given + POSE + 3)};
    for (std::size_t c = 0; c < 3; c++) next[1 + c] = {axes[0][c], axes[1][c], axes[2][c]};
    motions.push_back(BootMotion::between(from, to, at_rest ? next : now, next));
    now = next, given += POSE + MOTION;
  }
  if (!motions.empty()) dynamics_.move_boots(std::move(motions));
}

void FmuSledge::begin(double time) {
  move_boots(0.0, 1.0, true);
  if (!(dynamics_.settle() <= at_rest_))
    throw std::runtime_error("the sledge finds no equilibrium to start from on this snow");
  std::fill(dynamics_.state.rate.begin(), dynamics_.state.rate.end(), 0.0);
  dynamics_.state.rate[0] = parameter()[0];
  push();
  dynamics_.begin();
  begun_ = values[0] = time;
  tell();
}

void FmuSledge::step(double from, double to) {
  const double now = begun_ + dynamics_.time;
  require(std::fabs(from - now) <= SAME_TIME * std::max(1.0, std::fabs(now)),
          "a step begins at " + std::to_string(from) + " s; the sledge is at " + std::to_string(now) + " s");
  push();
  move_boots(dynamics_.time, to - begun_, false);
  Advance ended;
  do ended = dynamics_.advance(to - begun_, std::numeric_limits<long>::max());
  while (ended == Advance::PAUSED);
  if (ended != Advance::REACHED) throw std::runtime_error("the motion is too stiff or too rough to be followed");
  values[0] = to;
  tell();
}

void FmuSledge::write(ByteWriter& out) const {
  out.all(values), out.number(begun_);
  contact_.write(contact_.state(), out);
  dynamics_.write(out);
}

void FmuSledge::read(ByteReader& in) {
  in.all(values), begun_ = in.number();
  contact_.take(contact_.read(in));
  dynamics_.read(in);
}

void FmuSledge::tell() {
  const BodyState& state = dynamics_.state;
  double* to = std::copy_n(state.position.begin(), 3, output());
  put_quaternion(state.rotation, to);
  to += 4;
  for (int part = 0; part < 2; part++) {
    const Vector3 in_space = state.in_space(vector_at(state.rate.data() + 3 * part));
    to = std::copy_n(in_space.begin(), 3, to);
  }
  for (int k = 0; k < contact_.runners(); k++)
    for (int part = 0; part < 2; part++) to = std::copy_n(dynamics_.boot_wrench(k)[part].begin(), 3, to);
}

}  // namespace skisnow
