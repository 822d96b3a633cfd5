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

void require_unit(const Vector3& direction) {
  if (!(std::fabs(dot(direction, direction) - 1.0) < UNIT)) refuse_bytes("a direction in them is none");
}

// Pairs of functions: one writes with a `ByteWriter`, one reads with a `ByteReader`.

template <class Stream, class Direction>
void pass_direction(Stream& stream, Direction& direction) {
  stream.all(direction);
  if (Stream::READS) require_unit(direction);
}

template <class Stream, class Rotation>
void pass_rotation(Stream& stream, Rotation& rotation) {
  stream.numbers(&rotation[0][0], 9);
  for (const auto& row : rotation)
    if (Stream::READS) require_unit(vector_at(row));
}

template <class Stream, class Knots>
void pass_places(Stream& stream, Knots& place, int count) {
  stream.numbers(place, std::size_t(count), MOST_ACROSS);
  for (int j = 1; j < count && Stream::READS; j++)
    if (place[j] < place[j - 1]) refuse_bytes("places across a line of snow do not rise");
}

template <class Stream, class Delayed>
void pass_delayed(Stream& stream, Delayed& delayed) {
  auto count = std::int64_t(delayed.depth.size());
  stream.within(delayed.spacing, 1e-9, MOST_ACROSS), stream.whole(delayed.first, -MOST_PLACES, MOST_PLACES);
  stream.whole(count, 0, MOST_PLACES);
  stream.some(delayed.depth, count, MOST_ACROSS), stream.some(delayed.stress, count, MOST_STRESS);
}

template <class Stream, class AnyTrack>
void pass_track(Stream& stream, AnyTrack& track, int strips) {
  stream.all(track.origin, FARTHEST);
  pass_direction(stream, track.ahead), pass_direction(stream, track.lateral);
  stream.whole(track.strip, 0, strips - 1), stream.whole(track.number, -MOST_LINES, MOST_LINES);
  stream.whole(track.count, 2, KNOTS);
  pass_places(stream, track.place, track.count);
  stream.numbers(track.depth, std::size_t(track.count), MOST_ACROSS);
  stream.numbers(track.delayed, std::size_t(track.count), MOST_ACROSS);
  stream.number(track.left_at);
}

template <class Stream>
void pass_line(Stream& stream, GrooveLines::Line& line) {
  for (int field = 0; field < LINE_FIELDS; field++) {
    const bool of_snow = field == HARDNESS || field == EXCESS || field == STRENGTH || field == STRENGTH_HELD;
    stream.numbers(line.values + field, 1, of_snow ? MOST_STRESS : FARTHEST);
  }
  for (const int from : {AHEAD_X, NORMAL_X})
    if (Stream::READS) require_unit(vector_at(line.values + from));
  stream.whole(line.ground.count, 0, KNOTS);
  pass_places(stream, line.ground.place, line.ground.count);
  stream.numbers(line.ground.depth, std::size_t(line.ground.count), MOST_ACROSS);
}

template <class Stream, class AnyPose>
void pass_pose(Stream& stream, AnyPose& pose, int nodes) {
  auto count = std::int64_t(pose.beam.size());
  stream.all(pose.position, FARTHEST), pass_rotation(stream, pose.rotation), stream.whole(count, 0, 3 * nodes);
  if (count != 0 && count != 3 * nodes) refuse_bytes("a pose has another number of nodes");
  stream.some(pose.beam, count, FARTHEST);
}

template <class Stream, class State>
void pass_body(Stream& stream, State& state) {
  stream.all(state.position, FARTHEST), pass_rotation(stream, state.rotation);
  stream.all(state.bend, FARTHEST), stream.all(state.rate, FARTHEST);
}

}  // namespace

void Archive::write(const Mark& mark, ByteWriter& out) const {
  require_kept(mark);
  out.whole(mark.strips), out.number(mark.energy), out.number(mark.time), out.whole(std::int64_t(mark.tracks));
  for (std::size_t i = 0; i < mark.tracks; i++) pass_track(out, tracks_[i], mark.strips);
}

Archive Archive::read(ByteReader& in) {
  Archive out;
  out.strips_ = int(in.whole(0, MOST_COUNT));
  const double energy = in.number();
  out.time = in.number();
  const auto count = in.whole(0, MOST_COUNT);
  for (std::int64_t i = 0; i < count; i++) {
    Track track{};
    pass_track(in, track, out.strips_);
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
    Line line(*this, slot(n));
    pass_line(out, line);
    pass_delayed(out, delayed[std::size_t(line.slot)]);
    out.number(energy_[std::size_t(line.slot)]), out.number(counted_[std::size_t(line.slot)]);
  }
}

void GrooveLines::read(ByteReader& in) {
  first = in.whole(-MOST_LINES, MOST_LINES), end = in.whole(first, first + capacity() - BLOCK);
  for (std::int64_t n = first; n < end; n++) {
    Line line(*this, slot(n));
    pass_line(in, line);
    put_back(line);
    pass_delayed(in, delayed[std::size_t(line.slot)]);
    in.number(energy_[std::size_t(line.slot)]), in.number(counted_[std::size_t(line.slot)]);
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
  for (std::size_t k = 0; k < state.accepted.size(); k++) pass_pose(out, state.accepted[k], runner(int(k)).nodes());
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
    for (int k = 0; k < runners(); k++) pass_pose(in, state.accepted.emplace_back(), runner(k).nodes());
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

template <class Stream, class Ski>
void MovingSki::pass(Stream& stream, Ski& ski) {
  pass_body(stream, ski.state_), stream.all(ski.now_, FARTHEST), stream.all(ski.before_, FARTHEST);
}

// All except values that are computed again before they are used.
template <class Stream, class Motion>
void Dynamics::pass(Stream& stream, Motion& of) {
  pass_body(stream, of.state);
  stream.all(of.rate_before_, FARTHEST), stream.all(of.moved_, FARTHEST);
  stream.number(of.time), stream.number(of.last_step_);
  stream.within(of.share_, 0.0, 1.0), stream.within(of.step_, 0.0, of.rule_.longest), stream.number(of.contraction_);
  for (auto* work : {&of.work_, &of.last_work_})
    for (double Work::* each : Work::PARTS) stream.number(work->*each);
  for (double SnowStore::* each : SnowStore::PARTS) stream.number(of.store_.*each);
  for (auto* each : {&of.losses_.penetration, &of.losses_.shear, &of.losses_.rate, &of.losses_.friction})
    stream.number(each->total), stream.number(each->open);
  for (auto* each : {&of.start_.kinetic, &of.start_.potential, &of.start_.elastic}) stream.number(*each);
  stream.whole(of.narrowed_, 0, 64), stream.number(of.free_);
  auto& counts = of.counts_;
  for (auto* each : {&counts.steps, &counts.rejected, &counts.looks, &counts.factored, &counts.iterations})
    stream.whole(*each, 0, MOST_LINES);
  for (auto& each : of.skis_) MovingSki::pass(stream, each);
}

void Dynamics::write(ByteWriter& out) const {
  if (!motions_.empty() || held_) throw std::logic_error("a body whose boots move has no form in bytes");
  pass(out, *this);
}

void Dynamics::read(ByteReader& in) { pass(in, *this); }

}  // namespace skisnow
