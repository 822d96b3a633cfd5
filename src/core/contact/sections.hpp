// Where a base meets the lines: for each line the plane section of the ski that lies over it, and what the snow
// answers.
#pragma once

#include <algorithm>
#include <cmath>

#include "beam/runner.hpp"
#include "linear_algebra/bordered.hpp"
#include "snow/lines.hpp"
#include "snow/snow.hpp"
#include "support/columns.hpp"

namespace skisnow {

// One struct of arrays for each stage of an evaluation. Vectors are in the ski's axes (0 ahead, 1 left across the base,
// 2 off the base), from the boot. x counts across along the line, to the left, from the grip: the edge that alone is in
// the snow, or a point between both edges by their depths.
// clang-format off: fields that belong together share a row

// The base over each line (find_sections).
enum BaseField {
  // the line: its place from the boot, its directions ahead, out of the snow, and to the left
  FROM_BOOT_0, FROM_BOOT_1, FROM_BOOT_2, LINE_AHEAD_0, LINE_AHEAD_1, LINE_AHEAD_2,
  LINE_NORMAL_0, LINE_NORMAL_1, LINE_NORMAL_2, LINE_LEFT_0, LINE_LEFT_1, LINE_LEFT_2,
  // the section: position along the ski, share of the spacing (m), half width and its slope, height of the base and its
  // slope, place in its beam element (from the front), that element's length
  STATION, SHARE, HALF_WIDTH, FLARE, BASE_HEIGHT, BASE_RISE, IN_ELEMENT, ELEMENT_LENGTH, ELEMENT,
  // sine and cosine of the twist, its slope; sine of the edge angle
  TWIST_SINE, TWIST_COSINE, TWIST_SLOPE, EDGE_SINE,
  // the grip: its depth, across from the ski's middle (before the base is cut: over the half width), to the left and
  // upwards from the boot, across from the line's origin (m)
  GRIP_DEPTH, GRIP_REACH, GRIP_LEFT, GRIP_UP, GRIP_PLACE,
  // depth of the deeper edge and of both, and their x (m); the right edge's fields follow the left one's
  DEEPEST, LEFT_DEPTH, RIGHT_DEPTH, LEFT_X, RIGHT_X,
  // in the surface: across the grip's direction, along it, and one over its length before it was made a unit
  ACROSS_0, ACROSS_1, ACROSS_2, ALONG_0, ALONG_1, ALONG_2, ALONG_SIZE,
  // fall of the depth to the left; its growth along the edge; width across the base over that along the line; where the
  // wet base begins and ends
  DEPTH_FALL, DEPTH_CLIMB, BASE_WIDENING, WET_FROM, WET_TO,
  GRIP_SKEW,  // how far the grip's place moves along the line as the line moves ahead by one
  BASE_FIELDS
};

// The pressure on each section (press, or a law from outside).
enum PressureField {
  FORCE, MOMENT, SNOW_ENERGY,  // force (N), its moment about the grip (N m), elastic energy of the snow (J)
  RATE_POWER,                  // that the dashpot of snow that takes time takes (W)
  // on demand: growth of force and moment with the depth of the grip, its fall, its place, and the wet base's ends
  FORCE_BY_DEPTH, FORCE_BY_FALL, FORCE_BY_PLACE, MOMENT_BY_DEPTH, MOMENT_BY_FALL, MOMENT_BY_PLACE, FORCE_BY_FROM,
  FORCE_BY_TO,
  PRESSURE_FIELDS
};

// The hold of the snow at the edges (press, or a law from outside): share of the strength that is left after slip, shear
// strength S_f and the thrust off the snow that comes with it (Pa); of each edge the share of the displacement to full
// strength in use, and the part of it by which the edge was eased.
enum EdgeField {
  STRENGTH_LEFT, EDGE_STRENGTH, EDGE_THRUST, LEFT_USED, RIGHT_USED, LEFT_EASED, RIGHT_EASED,
  LOADED,  // share of the depth whose base bears; only where the law asks for it
  EDGE_FIELDS
};

// Sliding (slide, or a law from outside), along the edge and aside: velocity of the base at the centre of pressure (m/s),
// μ and its growth with the speed (s/m), share of μ in use in parts, each with the sign of its way.
enum SlidingField {
  SLIDING, SLIDING_ASIDE, MU, MU_GROWTH, RUB, RUB_ASIDE,
  // growth of the shares with the way since the base stuck (1/m), or with the velocity where it did not yet (s/m): along
  // by along, each by the other, aside by aside
  RUB_SLOPE, RUB_SKEW, RUB_ASIDE_SLOPE,
  RUB_BY_WAY,                 // which of both (1 or 0)
  ASIDE_0, ASIDE_1, ASIDE_2,  // the direction aside, in the ski's axes
  SLIDING_FIELDS
};

// The forces of each section (push): shear across both edges together and each of them, the force along, that of
// friction across in the surface and off the surface, the load that friction acts on (N); force and moment about the
// boot in the ski's axes; force and moment on the beam.
enum ForceField {
  SHEAR, LEFT_SHEAR, RIGHT_SHEAR, PUSH, PUSH_ACROSS, PUSH_OFF, FRICTION_LOAD,
  FORCE_0, FORCE_1, FORCE_2, MOMENT_0, MOMENT_1, MOMENT_2, BEAM_FORCE, BEAM_MOMENT,
  FORCE_FIELDS
};
// clang-format on

struct Base : Columns<BaseField, BASE_FIELDS> {
  std::int64_t first_block = 0;  // first block of lines
  EdgeShape edge_shape;          // shape of the runner's edges
  int blocks = 0;
  enum Wanted : unsigned char { NOTHING, STATIONS, SECTIONS };
  std::vector<Wanted> wanted;  // of each block; that of a neighbour needs stations

  int count() const { return blocks * BLOCK; }
  std::int64_t line(int i) const { return first_block * BLOCK + i; }
  int index(std::int64_t line) const { return int(line - first_block * BLOCK); }
  bool touches(int i) const { return (*this)[SHARE][i] > 0.0 && (*this)[DEEPEST][i] > 0.0; }
  // Angle of the base next to the edge with the snow (rad): that of the strip where it is bevelled.
  double face_angle(int i) const {
    return std::max(std::asin(std::min(std::fabs((*this)[EDGE_SINE][i]), 1.0)) - edge_shape.bevel(), 0.0);
  }
  bool wants(Wanted what, int i) const { return wanted[std::size_t(i / BLOCK)] >= what; }
  void cover(const GrooveLines& lines, const double* of);
};
// A field of the left edge (0) or of the right one (1).
constexpr BaseField of_edge(BaseField left, int edge) { return BaseField(left + edge); }
constexpr EdgeField of_edge(EdgeField left, int edge) { return EdgeField(left + edge); }
constexpr ForceField of_edge(ForceField left, int edge) { return ForceField(left + edge); }
constexpr LineField of_edge(LineField left, int edge) { return LineField(left + edge); }

using Pressures = Columns<PressureField, PRESSURE_FIELDS>;
using EdgeHold = Columns<EdgeField, EDGE_FIELDS>;
using Sliding = Columns<SlidingField, SLIDING_FIELDS>;
using SectionForces = Columns<ForceField, FORCE_FIELDS>;

// All stages of one runner, for readers of more than one. A field's type tells its stage.
struct Sections {
  Base base;
  Pressures pressure;
  EdgeHold edge;
  Sliding sliding;
  SectionForces forces;

  Sections() = default;
  explicit Sections(int capacity);  // number of lines that the runner's ring holds

  int count() const { return base.count(); }
  std::int64_t line(int i) const { return base.line(i); }
  int index(std::int64_t line) const { return base.index(line); }
  bool touches(int i) const { return base.touches(i); }
  const double* operator[](BaseField field) const { return base[field]; }
  const double* operator[](PressureField field) const { return pressure[field]; }
  const double* operator[](EdgeField field) const { return edge[field]; }
  const double* operator[](SlidingField field) const { return sliding[field]; }
  const double* operator[](ForceField field) const { return forces[field]; }
};

struct Wrench {
  double force[3] = {}, moment[3] = {};  // in the ski's axes, about the boot
  std::vector<double> beam;              // (nodes, 3): force, moment of the slope, moment of the twist
};

// How the eight answers of a section (force, moment about the boot, force and moment on the beam) change with three
// local movements of the base: to the left across it, off it, and its twist. Minus the derivatives.
struct SectionDifferences {
  static constexpr int ANSWERS = 8;
  enum Change { LEFT, OFF, TWIST, CHANGES };
  std::vector<double> values;  // [change][answer][section]
  int count = 0;

  void resize(int sections) {
    count = sections;
    values.resize(std::size_t(ANSWERS * CHANGES) * std::size_t(sections));
  }
  double* column(int change, int answer) {
    return values.data() + (std::size_t(change) * ANSWERS + std::size_t(answer)) * std::size_t(count);
  }
  const double* column(int change, int answer) const {
    return const_cast<SectionDifferences*>(this)->column(change, answer);
  }
};

struct RunnerTangent;

// Powers of the snow on a runner (W): across the edge, along it by friction, and of the rest of the force on the base;
// `damping` is the part of the last that the snow's dashpot c takes.
struct ContactPower {
  double shear, friction, normal, damping;
};

// The stages of an evaluation, each over all lines of a runner: a function from structs to structs without hidden
// state.
struct Kernels {
  const char* name;  // instruction set
  int lanes;
  // in the blocks with a line that `of` (by slot) has 1 for, or null for all of them
  void (*find_sections)(const Runner&, const Pose&, const GrooveLines&, const double* of, Base&);
  // with `grows` the pressure's growth
  void (*press)(const Snow&, const GrooveLines&, const Base&, bool grows, Pressures&, EdgeHold&);
  void (*slide)(const Motion&, const Pose&, double dt, const Snow&, const GrooveLines&, const Base&, const Pressures&,
                Sliding&);
  void (*push)(const Snow&, const Base&, const Pressures&, const EdgeHold&, const Sliding&, SectionForces&, Wrench&);
  // all but the normal part
  ContactPower (*sum_power)(const Motion&, const Pose&, const Sections&);
  // of sections whose pressure's growth is known; a step (m, rad), and its sense to the left and of the twist
  void (*differ)(const Snow&, const GrooveLines&, const Sections&, double step, double sense, bool is_level,
                 SectionDifferences&);
  // add the sections' derivatives to a tangent, and those of friction by way and by velocity, all weighted
  void (*add_stiffness)(const Sections&, const SectionDifferences&, double stiffness, double by_way, double by_speed,
                        bool bends, RunnerTangent&);
  // loops over lines only, see line_kernels.hpp; all by slot
  bool (*find_unknown)(const GrooveLines&, const Pose&, double room, double* is_unknown);
  void (*square_depths)(const GrooveLines&, double* out);
  // marks of a base on its lines, see mark_kernels.hpp; `of`, by slot, and `eased` of `mark` may be null
  void (*mark)(const Snow&, const Base&, const double* of, const EdgeHold* eased, GrooveLines&);
  void (*drag_anchors)(const Snow&, const Base&, const double* of, GrooveLines&);
  void (*find_vertices)(const Runner&, const Base&, const GrooveLines&, double* out);
  BandKernels band;
};

constexpr double NO_VERTEX = -1e300;

const Kernels& kernels();                        // the widest that this processor has
const Kernels* kernels_named(const char* name);  // null: not in this library, or not on this processor

}  // namespace skisnow
