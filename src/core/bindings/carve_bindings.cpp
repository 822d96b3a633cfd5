// The steady carve in Python: plain arrays in and out. skisnow.carving gives it names and documentation.
#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>

#include <algorithm>
#include <chrono>
#include <stdexcept>

#include "bindings/arrays.hpp"
#include "carve/carve.hpp"
#include "carve/equations.hpp"
#include "carve/point.hpp"
#include "carve/strip.hpp"
#include "linear_algebra/banded.hpp"

namespace skisnow {
namespace {

// One row for each station: place, weight, width, base height, first unknown, shapes of deflection (6) and twist (6).
void set_stations(CarvedSki& ski, const Array& rows) {
  constexpr int DEFLECTION = 5, TWIST = 11, COLUMNS = 17;
  for (std::size_t i = 0; i < rows.shape(0); i++) {
    const double* row = rows.data() + COLUMNS * i;
    CarveStation station{row[0], row[1], 0.5 * row[2], row[3], {}, {}, int(row[4])};
    for (int a = 0; a < 4; a++) station.deflection[a] = row[DEFLECTION + BENDS[a]];
    for (int a = 0; a < 2; a++) station.twist[a] = row[TWIST + TURNS[a]];
    ski.stations.push_back(station);
    ski.greatest_width = std::max(ski.greatest_width, row[2]);
  }
}

CarvedSki carved_ski(const Array& stations, int front, const Array& stiffness, double waist, double running_length,
                     const Array& bent_by_width, const Array& bent_by_height) {
  CarvedSki out;
  set_stations(out, stations);
  const int free = int(stiffness.shape(0));
  out.front = front;
  out.size = free + CarvedSki::HELD;
  out.stiffness.assign(std::size_t(CARVE_BAND * (out.size + BAND_HALF)), 0.0);
  for (int i = 0; i < free; i++) {
    const double* from = stiffness.data() + CARVE_BAND * i;
    std::copy_n(from, CARVE_BAND, out.stiffness.data() + CARVE_BAND * (i < front ? i : i + CarvedSki::HELD));
  }
  for (int i = front; i < front + CarvedSki::HELD; i++) out.stiffness[std::size_t(CARVE_BAND * i + BAND_HALF)] = 1.0;
  out.waist = waist;
  out.running_length = running_length;
  out.bent_by_width = out.spread(bent_by_width.data());
  out.bent_by_height = out.spread(bent_by_height.data());
  return out;
}

// A long search handles Python's signals; it holds the lock only for that.
std::function<void()> answering_signals() {
  using Clock = std::chrono::steady_clock;
  return [last = Clock::now()]() mutable {
    if (Clock::now() - last < std::chrono::milliseconds(50)) return;
    last = Clock::now();
    nb::gil_scoped_acquire held;
    if (PyErr_CheckSignals() != 0) throw nb::python_error();
  };
}

// One number back for each point.
template <class... Points>
CarveLaws::Values asked(const nb::object& law, const Points&... points) {
  nb::gil_scoped_acquire held;
  const std::size_t wanted = std::max({points.size()...});
  const auto found = nb::cast<Array>(law(array(points)...));
  if (found.size() != wanted) throw std::invalid_argument("a law must give one value for each point");
  return CarveLaws::Values(found.data(), found.data() + wanted);
}

// Laws in Python, or none: `pressure` and `residual` of arrays, `strength` over one that all have in common.
void set_laws(CarveLaws& out, const nb::object& pressure, const nb::object& residual, const Array& bends,
              const nb::object& strength) {
  using Values = CarveLaws::Values;
  if (!pressure.is_none()) {
    out.pressure = [pressure](const Values& depth, const Values& deepest, const Values& angle) {
      return asked(pressure, depth, deepest, angle);
    };
    out.residual = [residual](const Values& deepest) { return asked(residual, deepest); };
  }
  out.bends = copied(bends);
  if (strength.is_none()) return;
  out.strength = [strength](const Values& depth, const Values& angle) { return asked(strength, depth, angle); };
}

nb::tuple border_of(const CarveState& at) { return nb::make_tuple(at.border[0], at.border[1], at.border[2]); }

CarveState state_of(const CarvedSki& ski, const Array& u, const Array& border) {
  const double* b = border.data();
  return {ski.spread(u.data()), {b[0], b[1], b[2]}};
}

nb::tuple find(const CarvedSki& ski, CarveConditions conditions, const std::optional<Array>& offset,
               const std::optional<nb::tuple>& near, const CarveLaws* laws) {
  conditions.laws = laws;
  CarveSolution found;
  CarveState from;
  if (near) from = state_of(ski, nb::cast<Array>((*near)[0]), nb::cast<Array>((*near)[1]));
  std::vector<double> beside = offset ? copied(*offset) : std::vector<double>();
  {
    nb::gil_scoped_release free;
    found = find_carve(ski, conditions, std::move(beside), near ? &from : nullptr, answering_signals());
  }
  return nb::make_tuple(found.converged, found.iterations, array(ski.gathered(found.state.u)), border_of(found.state),
                        array(std::move(found.depth)), array(std::move(found.force)));
}

// J⁻¹ r, with the Jacobian J of the equations at a state and the groove kept at these places across; for tests.
nb::tuple carve_solution(const CarvedSki& ski, const CarveConditions& conditions, const Array& places, const Array& u,
                         const Array& border, const Array& right, const Array& right_border) {
  CarveGroove groove(ski.stations.size());
  groove.edge.place = copied(places);
  const CarveState at = state_of(ski, u, border);
  CarveState step = at;
  CarveEquations system(ski);
  assemble(ski, conditions, groove, at, system);
  const Column spread = ski.spread(right.data());
  for (int i = 0; i < ski.size; i++) system.residual[std::size_t(i)] = -spread[std::size_t(i)];
  for (std::size_t a = 0; a < CARVE_BORDER; a++) system.border_residual[a] = -right_border.data()[a];
  CarveFactors factors;
  factors.factor(ski, system);
  if (!factors.correct(ski, system, step)) throw std::invalid_argument("the equations are singular");
  return nb::make_tuple(array(ski.gathered(step.u)), array({step.border.begin(), step.border.end()}));
}

void make_point(CarvePoint* at, const CarvedSki& ski, const CarveConditions& conditions, const Array& u,
                const Array& border, const std::optional<Array>& places) {
  new (at) CarvePoint(ski, conditions, places ? copied(*places) : std::vector<double>(), state_of(ski, u, border));
}

// Last correction, unknowns, depth and force of a refined equilibrium.
nb::tuple point_state(const CarvePoint& at) {
  return nb::make_tuple(at.last_correction(), array(at.ski().gathered(at.state().u)), border_of(at.state()),
                        array(at.depth()), array(at.force()));
}

// Gradient by the stations' columns (place, weight, width, base height, deflection, normal force), by the conditions,
// and the adjoint unknowns.
nb::tuple point_gradient(CarvePoint& at, const Array& u, const Array& depth, const Array& force) {
  CarveGradient found = at.gradient({at.ski().spread(u.data()), copied(depth), copied(force)});
  const std::size_t n = found.place.size();
  std::vector<double> columns;
  for (const auto* each :
       {&found.place, &found.weight, &found.width, &found.base_height, &found.deflection, &found.normal})
    columns.insert(columns.end(), each->begin(), each->end());
  return nb::make_tuple(
      array(std::move(columns), {6, n}),
      array({found.edge_angle, found.hardness, found.excess, found.load, found.moment, found.side_force, found.bevel,
             found.bevel_width, found.pitch_of_force, found.pitch_of_shear, found.running_length, found.greatest_width,
             found.side, found.radius}),
      array(at.ski().gathered(found.adjoint.u)));
}

// Growth of unknowns, border, depth and force along a direction, and the distance to the next kink in its unit.
// `columns`: place, weight, width, base height, stretch; `numbers` as of `point_gradient`; `bent`: of elastic forces.
nb::tuple point_growth(CarvePoint& at, const Array& columns, const Array& numbers, const Array& bent) {
  CarveDirection along;
  const std::size_t n = columns.shape(1);
  const double* from = columns.data();
  for (auto* each : {&along.place, &along.weight, &along.width, &along.base_height, &along.stretch}) {
    each->assign(from, from + n);
    from += n;
  }
  from = numbers.data();
  for (auto* each : {&along.edge_angle, &along.hardness, &along.excess, &along.load, &along.moment, &along.side_force,
                     &along.bevel, &along.bevel_width, &along.pitch_of_force, &along.pitch_of_shear,
                     &along.running_length, &along.greatest_width, &along.side, &along.radius})
    *each = *from++;
  along.bent = at.ski().spread(bent.data());
  CarveGrowth found = at.growth(along);
  return nb::make_tuple(array(at.ski().gathered(along.state.u)), border_of(along.state), array(std::move(found.depth)),
                        array(std::move(found.force)), found.kink);
}

// Behind the rows of a banded matrix, or of a right side, the zeros that loops over it need.
Column with_room(const Array& rows, std::size_t width) {
  Column out((rows.shape(0) + BAND_HALF) * width, 0.0);
  std::copy_n(rows.data(), rows.size(), out.data());
  return out;
}

Result banded_factors(const Array& matrix) {
  Column band = with_room(matrix, BAND_WIDTH);
  factor_band(band.data(), int(matrix.shape(0)));
  return array({band.data(), band.data() + matrix.size()}, {matrix.shape(0), std::size_t(BAND_WIDTH)});
}

// Of one right side, or of `BAND_TILE`; all rows before `from` are zero.
Result banded_solution(const Array& factors, const Array& right, int from) {
  const Column band = with_room(factors, BAND_WIDTH);
  Column x = with_room(right, right.shape(1));
  const BandBlock block{0, from, int(right.shape(0))};
  (right.shape(1) == 1 ? solve_band : solve_band_tile)(band.data(), x.data(), block);
  return array({x.data(), x.data() + right.size()}, {right.shape(0), right.shape(1)});
}

Result strip_sums(const Array& intervals) {
  StripSums sums;
  for (std::size_t i = 0; i < intervals.shape(0); i++) {
    const double* a = intervals.data() + 8 * i;
    sums.add_interval(a[0], a[1], a[2], a[3], a[4], a[5], a[6], a[7]);
  }
  std::vector<double> out = {sums.force, sums.moment};
  out.insert(out.end(), sums.by_depth, sums.by_depth + 3);
  out.insert(out.end(), sums.by_groove, sums.by_groove + 3);
  return array(std::move(out), {8});
}

}  // namespace

void bind_carve(nb::module_& m) {
  nb::class_<CarvedSki>(m, "CarvedSki");
  m.def("carved_ski", &carved_ski);
  nb::class_<CarveConditions>(m, "CarveConditions")
      .def("__init__",
           [](CarveConditions* at, double edge_angle, double hardness, double excess, double load, double moment,
              double side_force, bool side_force_bending, bool twists, double bevel, double bevel_width, double side,
              double radius, double pitch_of_force, double pitch_of_shear, bool by_reaction) {
             new (at) CarveConditions{edge_angle,         hardness,       excess,     load,        moment, side_force,
                                      side_force_bending, twists,         bevel,      bevel_width, side,   radius,
                                      pitch_of_force,     pitch_of_shear, by_reaction};
           });
  nb::class_<CarveLaws>(m, "CarveLaws")
      .def(
          "__init__",
          [](CarveLaws* at, const nb::object& pressure, const nb::object& residual, const Array& bends,
             const nb::object& strength) { set_laws(*new (at) CarveLaws, pressure, residual, bends, strength); },
          nb::arg("pressure").none(), nb::arg("residual").none(), nb::arg("bends"), nb::arg("strength").none());
  m.def("find_carve", &find, nb::arg("ski"), nb::arg("conditions"), nb::arg("offset").none(), nb::arg("near").none(),
        nb::arg("laws").none());
  m.def("carve_solution", &carve_solution);
  nb::class_<CarvePoint>(m, "CarvePoint")
      .def("__init__", &make_point, nb::keep_alive<1, 2>(), nb::arg("ski"), nb::arg("conditions"), nb::arg("u"),
           nb::arg("border"), nb::arg("places").none())
      .def("state", &point_state)
      .def("gradient", &point_gradient)
      .def("growth", &point_growth);
  m.def("banded_factors", &banded_factors);
  m.def("banded_solution", &banded_solution);
  m.def("strip_sums", &strip_sums);
}

}  // namespace skisnow
