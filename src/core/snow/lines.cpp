#include "snow/lines.hpp"

#include <algorithm>
#include <cmath>

namespace skisnow {

namespace {

constexpr double MARGIN = 0.12;    // (m) before tip and behind tail in which lines are laid: more than a step's way
constexpr int NEWTON_STEPS = 3;    // to the place on a curved surface
constexpr double MOST_TURN = 0.3;  // (rad) between a line's direction ahead and the ski
constexpr double MOST_OFF = 2e-4;  // (m) between a line and the surface under the ski
constexpr double FURTHER = 0.03;   // (m) beyond what is needed, over which older tracks are searched for

Vector3 unit(const Vector3& a) { return 1.0 / std::sqrt(dot(a, a)) * a; }

Vector3 get(const GrooveLines& lines, LineField first, int slot) {
  return {lines.values[first][slot], lines.values[LineField(first + 1)][slot],
          lines.values[LineField(first + 2)][slot]};
}

void put(GrooveLines& lines, LineField first, int slot, const Vector3& vector) {
  for (int a = 0; a < 3; a++) lines.values[LineField(first + a)][slot] = vector[a];
}

// The place on the surface under a position along the ski's straight axis.
Vector3 place_under(const Pose& pose, double station, const Snow& snow) {
  const Vector3 ahead = pose.axis(0);
  const Vector3 from = pose.position + station * ahead;
  const double level = ahead[0] * ahead[0] + ahead[1] * ahead[1];
  double way = 0.0;
  for (int i = 0; i < NEWTON_STEPS; i++) {
    const Grid::Value here = snow.surface.at(from[0] + way * ahead[0], from[1] + way * ahead[1]);
    const double rise = here.slope_x * ahead[0] + here.slope_y * ahead[1];
    way -= (way * level + (here.value - from[2]) * ahead[2]) / (level + rise * ahead[2]);
  }
  const double x = from[0] + way * ahead[0], y = from[1] + way * ahead[1];
  return {x, y, snow.surface.at(x, y).value};
}

// The ski's direction ahead in a surface, a unit vector.
Vector3 ahead_on(const Vector3& normal, const Pose& pose) {
  const Vector3 ahead = pose.axis(0);
  return unit(ahead - dot(ahead, normal) * normal);
}

int power_of_two(int least) {
  int size = 2 * BLOCK;
  while (size < least) size *= 2;
  return size;
}

}  // namespace

GrooveLines::GrooveLines(const Runner& runner, double spacing) : spacing_(spacing) {
  const int lines = int((runner.tip - runner.tail + 2.0 * MARGIN) / spacing) + 10;
  const int size = power_of_two(lines + 2 * BLOCK);
  values.resize(size);
  for (Column* each : {&place, &depth, &slope}) each->assign(std::size_t(size) * KNOTS, 0.0);
  knots.assign(std::size_t(size), 0);
  delayed.resize(std::size_t(size));
  filled_.assign(std::size_t(size / BLOCK), 1);
  energy_.assign(std::size_t(size), 0.0);
  counted_.assign(std::size_t(size), 0.0);
  for (int slot = 0; slot < size; slot++) {  // lanes beside the lines that are laid must hold numbers
    put(*this, AHEAD_X, slot, {1.0, 0.0, 0.0});
    put(*this, NORMAL_X, slot, {0.0, 0.0, 1.0});
    values[ORIGIN_Z][slot] = -1e3;
    values[HARDNESS][slot] = 1.0;
    keep(slot, Ground());
  }
}

Vector3 GrooveLines::origin(int slot) const { return get(*this, ORIGIN_X, slot); }

Vector3 GrooveLines::lateral(int slot) const { return cross(get(*this, NORMAL_X, slot), get(*this, AHEAD_X, slot)); }

Ground GrooveLines::ground(int slot) const {
  Ground out;
  const double *places = place.data() + tile(slot, 0), *depths = depth.data() + tile(slot, 0);
  for (int j = 0; j < knots[std::size_t(slot)]; j++) out.place[j] = places[BLOCK * j], out.depth[j] = depths[BLOCK * j];
  out.count = knots[std::size_t(slot)];
  return out;
}

void GrooveLines::keep(int slot, const Ground& ground) {
  const auto block = std::size_t(slot / BLOCK);
  knots[std::size_t(slot)] = std::uint8_t(ground.count);
  for (int j = 0; j < ground.count; j++) {
    const auto at = std::size_t(tile(slot, j));
    place[at] = ground.place[j];
    depth[at] = ground.depth[j];
    const double width = j + 1 < ground.count ? ground.place[j + 1] - ground.place[j] : 0.0;
    slope[at] = width > THIN ? (ground.depth[j + 1] - ground.depth[j]) / width : 0.0;
  }
  const int before = filled_[block];
  if (ground.count > before) {
    filled_[block] = std::uint8_t(ground.count);
    for (int other = slot / BLOCK * BLOCK, end = other + BLOCK; other < end; other++)
      if (other != slot) fill(other, before, ground.count);
  }
  fill(slot, ground.count, filled_[block]);
}

// Places beyond the last knot repeat it, so that a block's lines may be summed together.
void GrooveLines::fill(int slot, int from, int to) {
  const int last = knots[std::size_t(slot)] - 1;
  for (int j = from; j < to; j++) {
    const auto at = std::size_t(tile(slot, j));
    place[at] = last < 0 ? 1e9 : place[std::size_t(tile(slot, last))];
    depth[at] = last < 0 ? 0.0 : depth[std::size_t(tile(slot, last))];
    slope[at] = 0.0;
  }
}

GrooveLines::Line::Line(const GrooveLines& lines, int slot) : slot(slot), ground(lines.ground(slot)) {
  for (int field = 0; field < LINE_FIELDS; field++) values[field] = lines.values[LineField(field)][slot];
}

void GrooveLines::put_back(const Line& line) {
  for (int field = 0; field < LINE_FIELDS; field++) values[LineField(field)][line.slot] = line.values[field];
  keep(line.slot, line.ground);
}

double GrooveLines::station(std::int64_t number, const Pose& pose) const {
  const int at = slot(number);
  const Vector3 ahead = pose.axis(0), left = pose.axis(1), lateral = this->lateral(at);
  const Vector3 there = origin(at) - pose.position;
  return dot(there, ahead) - dot(there, left) * dot(lateral, ahead) / dot(lateral, left);
}

void GrooveLines::lay(std::int64_t number, const Pose& pose, double station, const Snow& snow) {
  const int at = slot(number);
  const Vector3 origin = place_under(pose, station, snow);
  const Grid::Value here = snow.surface.at(origin[0], origin[1]);
  const Vector3 normal = unit({-here.slope_x, -here.slope_y, 1.0});
  put(*this, ORIGIN_X, at, origin);
  put(*this, AHEAD_X, at, ahead_on(normal, pose));
  put(*this, NORMAL_X, at, normal);
  for (int field = MARKED; field < LINE_FIELDS; field++) values[LineField(field)][at] = 0.0;
  take_snow(at, origin, snow);
  keep(at, Ground());
  delayed[std::size_t(at)] = DelayedGround{snow.rate.spacing};
  energy_[std::size_t(at)] = counted_[std::size_t(at)] = 0.0;
}

void GrooveLines::take_snow(int slot, const Vector3& at, const Snow& snow) {
  const double hardness = snow.hardness.at(at[0], at[1]).value;
  values[HARDNESS][slot] = hardness;
  values[EXCESS][slot] = (snow.unloading_ratio - 1.0) * hardness;
  values[STRENGTH][slot] = snow.strength.at(at[0], at[1]).value;
  values[FRICTION][slot] = snow.friction_share.at(at[0], at[1]).value;
}

void GrooveLines::follow_snow(int slot, double place, const Snow& snow) {
  const double before = energy_per_metre(slot, ground(slot));
  const Vector3 from = origin(slot), across = lateral(slot);
  take_snow(slot, {from[0] + place * across[0], from[1] + place * across[1], 0.0}, snow);
  counted_[std::size_t(slot)] += energy_per_metre(slot, ground(slot)) - before;
}

double GrooveLines::aside(int slot, const Pose& pose) const {
  const Vector3 ahead = pose.axis(0), lateral = this->lateral(slot), along = get(*this, AHEAD_X, slot);
  const Vector3 there = pose.position - origin(slot);
  return dot(there, lateral) - dot(there, along) * dot(ahead, lateral) / dot(ahead, along);
}

int GrooveLines::unknown(int slot, const Pose& pose, double room, double (&from)[2], double (&to)[2]) const {
  const double at = aside(slot, pose), low = at - room, high = at + room;
  const double known_from = values[KNOWN_FROM][slot], known_to = values[KNOWN_TO][slot];
  int count = 0;
  if (!(known_from < known_to)) {
    from[0] = low - FURTHER, to[0] = high + FURTHER;
    return 1;
  }
  if (low < known_from) from[count] = low - FURTHER, to[count++] = known_from;
  if (high > known_to) from[count] = known_to, to[count++] = high + FURTHER;
  return count;
}

double GrooveLines::energy_per_metre(int slot, const Ground& ground) const {
  return lost ? lost(ground) : energy_of(slot, ground.squared());
}

double GrooveLines::energy_of(int slot, double squared) const {
  const double hardness = values[HARDNESS][slot], excess = values[EXCESS][slot];
  return 0.5 * hardness * excess / (hardness + excess) * squared;
}

void GrooveLines::count(int slot, double length, double energy_per_metre) {
  double& counted = counted_[std::size_t(slot)];
  energy_[std::size_t(slot)] += (energy_per_metre - counted) * length;
  counted = energy_per_metre;
}

void GrooveLines::count_energy(int slot, double length) { count(slot, length, energy_per_metre(slot, ground(slot))); }

void GrooveLines::count_energy(int slot, double length, double squared) {
  count(slot, length, energy_of(slot, squared));
}

void GrooveLines::press_older(int slot, const Ground& older) {
  Ground ground = this->ground(slot);
  const double before = energy_per_metre(slot, ground);
  if (!ground.press(older.place, older.depth, older.count)) return;
  ground.simplify(0.0, KNOTS);
  keep(slot, ground);
  counted_[std::size_t(slot)] += energy_per_metre(slot, ground) - before;
}

double GrooveLines::groove_energy() const {
  double total = 0.0;
  for (std::int64_t n = first; n < end; n++) total += energy_[std::size_t(slot(n))];
  return total;
}

Track GrooveLines::track(std::int64_t number, int strip, double time) const {
  const int at = slot(number);
  const Ground here = ground(at);
  Track out{origin(at), get(*this, AHEAD_X, at), lateral(at), strip, number, here.count, {}, {}, {}, time};
  std::copy_n(here.place, here.count, out.place);
  std::copy_n(here.depth, here.count, out.depth);
  const DelayedGround& springing = delayed[std::size_t(at)];
  for (int j = 0; j < here.count && !springing.empty(); j++) out.delayed[j] = springing.depth_at(here.place[j]);
  return out;
}

void GrooveLines::leave(std::int64_t number, Archive* archive, int strip) {
  if (archive == nullptr) return;
  count_energy(slot(number), spacing_);
  archive->add(track(number, strip, archive->time), energy_[std::size_t(slot(number))]);
}

void GrooveLines::drop_left(const Runner& runner, const Pose& pose, Archive* archive, int strip) {
  const double room = MARGIN + 3.0 * spacing_;
  for (; count() > 0 && station(first, pose) < runner.tail - room; first++) leave(first, archive, strip);
  for (; count() > 0 && station(end - 1, pose) > runner.tip + room; end--) leave(end - 1, archive, strip);
}

void GrooveLines::lay_ahead(const Runner& runner, const Pose& pose, const Snow& snow) {
  if (count() == 0) lay(end++, pose, 0.0, snow);
  const int most = capacity() - BLOCK;
  double at = station(end - 1, pose);
  while (at < runner.tip + MARGIN && count() < most) lay(end++, pose, at += spacing_, snow);
  at = station(first, pose);
  while (at > runner.tail - MARGIN && count() < most) lay(--first, pose, at -= spacing_, snow);
}

bool GrooveLines::is_left(const Pose& pose, const Snow& snow) const {
  const Vector3 there = get(*this, AHEAD_X, slot(first)), ahead = ahead_on(get(*this, NORMAL_X, slot(first)), pose);
  return dot(there, ahead) < std::cos(MOST_TURN) || is_off_surface(slot((first + end) / 2), pose, snow);
}

// Whether the surface under the ski is not that of a line any more, because the ski has gone aside on it.
bool GrooveLines::is_off_surface(int slot, const Pose& pose, const Snow& snow) const {
  const double across = aside(slot, pose);
  const Vector3 from = origin(slot), along = lateral(slot);
  const double x = from[0] + across * along[0], y = from[1] + across * along[1], z = from[2] + across * along[2];
  return std::fabs(snow.surface.at(x, y).value - z) > MOST_OFF;
}

void GrooveLines::leave_all(Archive& archive, int strip) {
  for (; first < end; first++) leave(first, &archive, strip);
}

}  // namespace skisnow
