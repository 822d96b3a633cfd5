// States of contacts and bodies as bytes, for another of the same in this process or a later one.
#include <algorithm>
#include <cmath>
#include <utility>

#include "dynamics/dynamics.hpp"
#include "fmi/model_data.hpp"
#include "support/bytes.hpp"

namespace skisnow {

namespace {

constexpr std::uint64_t CONTACT = 1;                        // among what is kept as bytes
constexpr std::int64_t MOST_LINES = std::int64_t(1) << 62;  // number of a line, to both sides
constexpr std::int64_t MOST_COUNT = std::int64_t(1) << 30;
constexpr double FARTHEST = 1e7;                   // (m) from the origin; the squares of tracks are counted up to there
constexpr double UNIT = 1e-6;                      // by which a direction's length may differ from 1
constexpr double MOST_ACROSS = 1e4;                // (m) along a line, and into the snow
constexpr double MOST_STRESS = 1e18;               // (Pa), (N/m³)
constexpr std::int64_t MOST_PLACES = 100'000'000;  // places of a line's delayed depth, from its origin

void read_place(ByteReader& in, Vector3& out) { in.all(out, FARTHEST); }

void require_unit(const Vector3& direction) {
  const double square = direction[0] * direction[0] + direction[1] * direction[1] + direction[2] * direction[2];
  if (!(std::fabs(square - 1.0) < UNIT)) refuse_bytes("a direction in them is none");
}

Vector3 read_direction(ByteReader& in) {
  Vector3 out;
  in.all(out);
  require_unit(out);
  return out;
}

void read_rotation(ByteReader& in, double (&out)[3][3]) {
  in.numbers(&out[0][0], 9);
  for (const auto& row : out) require_unit({row[0], row[1], row[2]});
}

void require_rising(const double* place, int count) {
  for (int j = 0; j < count; j++)
    if (j > 0 && place[j] < place[j - 1]) refuse_bytes("places across a line of snow do not rise");
}

void write_ground(const Ground& ground, ByteWriter& out) {
  out.whole(ground.count);
  out.numbers(ground.place, std::size_t(ground.count)), out.numbers(ground.depth, std::size_t(ground.count));
}

Ground read_ground(ByteReader& in) {
  Ground out;
  out.count = int(in.whole(0, KNOTS));
  for (double* each : {out.place, out.depth}) in.numbers(each, std::size_t(out.count), MOST_ACROSS);
  require_rising(out.place, out.count);
  return out;
}

void write_delayed(const DelayedGround& delayed, ByteWriter& out) {
  out.number(delayed.spacing), out.whole(delayed.first), out.whole(std::int64_t(delayed.depth.size()));
  out.all(delayed.depth), out.all(delayed.stress);
}

DelayedGround read_delayed(ByteReader& in) {
  DelayedGround out;
  out.spacing = in.within(1e-9, MOST_ACROSS), out.first = long(in.whole(-MOST_PLACES, MOST_PLACES));
  const auto count = std::size_t(in.whole(0, MOST_PLACES));
  out.depth = in.numbers(count, MOST_ACROSS), out.stress = in.numbers(count, MOST_STRESS);
  return out;
}

void write_track(const Track& track, ByteWriter& out) {
  out.all(track.origin), out.all(track.ahead), out.all(track.lateral);
  out.whole(track.strip), out.whole(track.number), out.whole(track.count);
  const auto count = std::size_t(track.count);
  out.numbers(track.place, count), out.numbers(track.depth, count), out.numbers(track.delayed, count);
  out.number(track.left_at);
}

Track read_track(ByteReader& in, int strips) {
  Track out{};
  read_place(in, out.origin);
  out.ahead = read_direction(in), out.lateral = read_direction(in);
  out.strip = int(in.whole(0, strips - 1)), out.number = in.whole(-MOST_LINES, MOST_LINES);
  out.count = int(in.whole(2, KNOTS));
  const auto count = std::size_t(out.count);
  for (double* each : {out.place, out.depth, out.delayed}) in.numbers(each, count, MOST_ACROSS);
  out.left_at = in.number();
  require_rising(out.place, out.count);
  return out;
}

void write_pose(const Pose& pose, ByteWriter& out) {
  out.all(pose.position), out.numbers(&pose.rotation[0][0], 9);
  out.whole(std::int64_t(pose.beam.size())), out.all(pose.beam);
}

Pose read_pose(ByteReader& in, int nodes) {
  Pose out;
  read_place(in, out.position), read_rotation(in, out.rotation);
  const auto count = std::size_t(in.whole(0, 3 * nodes));
  if (count != 0 && count != std::size_t(3 * nodes)) refuse_bytes("a pose has another number of nodes");
  out.beam = in.numbers(count, FARTHEST);
  return out;
}

}  // namespace

void Archive::write(const Mark& mark, ByteWriter& out) const {
  require_kept(mark);
  out.whole(mark.strips), out.number(mark.energy), out.number(mark.time), out.whole(std::int64_t(mark.tracks));
  for (std::size_t i = 0; i < mark.tracks; i++) write_track(tracks_[i], out);
}

Archive Archive::read(ByteReader& in) {
  Archive out;
  out.strips_ = int(in.whole(0, MOST_COUNT));
  const double energy = in.number();
  out.time = in.number();
  const auto count = in.whole(0, MOST_COUNT);
  for (std::int64_t i = 0; i < count; i++) {
    const Track track = read_track(in, out.strips_);
    const std::size_t before = out.tracks_.size();
    out.add(track, 0.0);
    if (out.tracks_.size() == before) refuse_bytes("a track in them has no width");
  }
  out.energy_ = energy;
  return out;
}

void GrooveLines::write(ByteWriter& out) const {
  out.whole(first), out.whole(end);
  for (std::int64_t n = first; n < end; n++) {
    const Line line = this->line(slot(n));
    out.numbers(line.values, LINE_FIELDS);
    write_ground(line.ground, out);
    write_delayed(delayed[std::size_t(line.slot)], out);
    out.number(energy_[std::size_t(line.slot)]), out.number(counted_[std::size_t(line.slot)]);
  }
}

void GrooveLines::read(ByteReader& in) {
  first = in.whole(-MOST_LINES, MOST_LINES), end = in.whole(first, first + capacity() - BLOCK);
  for (std::int64_t n = first; n < end; n++) {
    Line line{slot(n), {}, {}};
    for (int field = 0; field < LINE_FIELDS; field++) {
      const bool of_snow = field == HARDNESS || field == EXCESS || field == STRENGTH || field == STRENGTH_HELD;
      in.numbers(line.values + field, 1, of_snow ? MOST_STRESS : FARTHEST);
    }
    for (const int from : {AHEAD_X, NORMAL_X})
      require_unit({line.values[from], line.values[from + 1], line.values[from + 2]});
    line.ground = read_ground(in);
    put_back(line);
    delayed[std::size_t(line.slot)] = read_delayed(in);
    energy_[std::size_t(line.slot)] = in.number(), counted_[std::size_t(line.slot)] = in.number();
  }
}

// Of runners and snow, but for what of the snow may change during a run; laws from outside are in it as being there.
std::uint64_t SnowContact::fingerprint() const {
  Fields own;
  put_snow(*snow_, own), put_runners(runners_, lines(0).spacing(), own);
  own.put("snow.strength_share", 1.0);
  own.put("laws", std::vector{laws ? 1.0 : 0.0, bearing_ ? 1.0 : 0.0});
  return own.digest();
}

void SnowContact::write(const State& state, ByteWriter& out) const {
  out.put(fingerprint());
  snow_->archive.write(state.tracks, out);
  out.number(state.time), out.number(state.delayed_energy);
  for (int k = 0; k < runners(); k++) out.whole(state.strips[std::size_t(k)]), state.lines[std::size_t(k)].write(out);
  out.whole(state.accepted.empty() ? 0 : 1);
  for (const Pose& each : state.accepted) write_pose(each, out);
}

SnowContact::Kept SnowContact::read(ByteReader& in) const {
  if (in.take() != fingerprint()) refuse_bytes("they are of other runners, another snow or other laws");
  Kept out{{}, Archive::read(in)};
  State& state = out.state;
  state.time = in.number(), state.delayed_energy = in.number();
  for (int k = 0; k < runners(); k++) {
    state.strips.push_back(int(in.whole(0, out.tracks.strips() - 1)));
    GrooveLines lines(runner(k), this->lines(k).spacing());
    lines.lost = this->lines(k).lost;
    lines.read(in);
    state.lines.push_back(std::move(lines));
  }
  if (in.whole(0, 1) == 1)
    for (int k = 0; k < runners(); k++) state.accepted.push_back(read_pose(in, runner(k).nodes()));
  return out;
}

void SnowContact::take(Kept kept) {
  snow_->archive.replace(std::move(kept.tracks));
  state_ = std::move(kept.state);
  begun_ = false;
}

void check_bytes(const unsigned char* bytes, std::size_t size) { ByteReader::opened(CONTACT, bytes, size); }

Bytes bytes_of(const SnowContact& contact, const SnowContact::State& state) {
  ByteWriter out;
  contact.write(state, out);
  return out.sealed(CONTACT);
}

void take_bytes(SnowContact& contact, const unsigned char* bytes, std::size_t size) {
  ByteReader in = ByteReader::opened(CONTACT, bytes, size);
  SnowContact::Kept kept = contact.read(in);
  in.require_end();
  contact.take(std::move(kept));
}

namespace {

void write_body(const BodyState& state, ByteWriter& out) {
  out.all(state.position), out.numbers(&state.rotation[0][0], 9), out.all(state.bend), out.all(state.rate);
}

void read_body(ByteReader& in, BodyState& out) {
  read_place(in, out.position), read_rotation(in, out.rotation), in.all(out.bend, FARTHEST), in.all(out.rate, FARTHEST);
}

}  // namespace

void MovingSki::write(ByteWriter& out) const { write_body(state_, out), out.all(now_), out.all(before_); }

void MovingSki::read(ByteReader& in) { read_body(in, state_), in.all(now_, FARTHEST), in.all(before_, FARTHEST); }

// All except values that are computed again before they are used.
void Dynamics::write(ByteWriter& out) const {
  if (!motions_.empty() || held_) throw std::logic_error("a body whose boots move has no form in bytes");
  write_body(state, out);
  out.all(rate_before_), out.all(moved_);
  out.numbers(std::vector{time, last_step_, share_, step_, contraction_}.data(), 5);
  for (const Work* work : {&work_, &last_work_})
    for (const double Work::* each : Work::PARTS) out.number(work->*each);
  for (const double SnowStore::* each : SnowStore::PARTS) out.number(store_.*each);
  for (const Loss* each : {&losses_.penetration, &losses_.shear, &losses_.rate, &losses_.friction})
    out.number(each->total), out.number(each->open);
  out.numbers(std::vector{start_.kinetic, start_.potential, start_.elastic}.data(), 3);
  out.whole(narrowed_);
  for (const long each : {counts_.steps, counts_.rejected, counts_.looks, counts_.factored, counts_.iterations})
    out.whole(each);
  for (const MovingSki& each : skis_) each.write(out);
}

void Dynamics::read(ByteReader& in) {
  read_body(in, state);
  in.all(rate_before_, FARTHEST), in.all(moved_, FARTHEST);
  time = in.number(), last_step_ = in.number(), share_ = in.within(0.0, 1.0), step_ = in.within(0.0, rule_.longest);
  contraction_ = in.number();
  for (Work* work : {&work_, &last_work_})
    for (double Work::* each : Work::PARTS) work->*each = in.number();
  for (double SnowStore::* each : SnowStore::PARTS) store_.*each = in.number();
  for (Loss* each : {&losses_.penetration, &losses_.shear, &losses_.rate, &losses_.friction})
    each->total = in.number(), each->open = in.number();
  start_.kinetic = in.number(), start_.potential = in.number(), start_.elastic = in.number();
  narrowed_ = int(in.whole(0, 64));
  for (long* each : {&counts_.steps, &counts_.rejected, &counts_.looks, &counts_.factored, &counts_.iterations})
    *each = long(in.whole(0, MOST_LINES));
  for (MovingSki& each : skis_) each.read(in);
}

}  // namespace skisnow
