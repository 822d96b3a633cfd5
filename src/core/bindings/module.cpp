// The core in Python: plain arrays in and out. The package skisnow.contact gives it names, checks and documentation.
#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bindings/arrays.hpp"
#include "contact/contact.hpp"

namespace nb = nanobind;

namespace skisnow {
namespace {

Grid grid(double x0, double dx, double y0, double dy, const Array& values, bool goes_on) {
  const int nx = int(values.shape(0)), ny = int(values.shape(1));
  return Grid(x0, dx, nx, y0, dy, ny, copied(values), goes_on);
}

Runner runner(const Array& position, const Array& half_width, const Array& base_height, const Array& node,
              double base_bevel, double edge_width, double side_edge, double edge_radius) {
  return Runner::of(copied(position), copied(half_width), copied(base_height), copied(node),
                    EdgeShape(base_bevel, edge_width, side_edge, edge_radius));
}

using Beams = std::optional<std::vector<Array>>;

std::vector<std::vector<double>> beams_of(const Beams& beams, int runners) {
  std::vector<std::vector<double>> out(static_cast<std::size_t>(runners));
  for (std::size_t k = 0; k < out.size() && beams; k++) out[k] = copied((*beams)[k]);
  return out;
}

Situation situation(int runners, const Array& position, const Array& rotation, const Array* velocity, double dt,
                    const Beams& beams, const Beams& rates) {
  return situation_of(position.data(), rotation.data(), velocity == nullptr ? nullptr : velocity->data(), dt,
                      beams_of(beams, runners), beams_of(rates, runners));
}

struct PythonLaws {
  nb::object friction, shear;  // μ of speeds (m/s); strength and thrust (Pa) of depths (m) and edge angles (rad)
  FrictionLaw rule;            // how a μ from outside acts

  void operator()(int, Sections& s) const {
    nb::gil_scoped_acquire held;
    const auto n = std::size_t(s.count());
    std::vector<double> speed(n), angle(n), depth(n);
    for (std::size_t i = 0; i < n; i++) {
      const bool touches = s.touches(int(i));
      speed[i] = touches ? std::hypot(s[SLIDING][i], s[SLIDING_ASIDE][i]) : 0.0;
      angle[i] = touches ? s.base.face_angle(int(i)) : 0.0;
      depth[i] = touches ? std::max({s[LEFT_DEPTH][i], s[RIGHT_DEPTH][i], 0.0}) : 0.0;
    }
    if (!friction.is_none()) {
      const auto mu = nb::cast<Array>(friction(array(speed, {n})));
      if (mu.size() != n) throw std::invalid_argument("a friction law must give one value for each speed");
      std::copy_n(mu.data(), n, s.sliding[MU]);
      std::fill_n(s.sliding[MU_GROWTH], n, 0.0);
    }
    if (!shear.is_none()) {
      const auto found = nb::cast<Array>(shear(array(depth, {n}), array(angle, {n})));
      if (found.ndim() != 2 || found.shape(0) != 2 || found.shape(1) != n)
        throw std::invalid_argument("a shear law must give strength and thrust for each section");
      for (std::size_t i = 0; i < n; i++) {
        s.edge[EDGE_STRENGTH][i] = s[STRENGTH_LEFT][i] * found.data()[i];
        s.edge[EDGE_THRUST][i] = s[STRENGTH_LEFT][i] * found.data()[n + i];
      }
    }
  }
};

// A law of a point in Python: `residual`, `bear` and `lost` of arrays, as in `PenetrationLaw`.
void set_penetration(SnowContact& self, const nb::object& law, const Array& bends, bool along_base_normal) {
  const auto asked = [law](const char* name, std::size_t rows, const auto&... points) {
    nb::gil_scoped_acquire held;
    const auto found = nb::cast<Array>(law.attr(name)(array(points)...));
    const std::size_t wanted = rows * std::max({points.size()...});
    if (found.size() != wanted) throw std::invalid_argument("a penetration law must give one value for each point");
    return Values(found.data(), found.data() + wanted);
  };
  PenetrationLaw out;
  out.residual = [asked](const Values& deepest) { return asked("residual", 1, deepest); };
  out.bear = [asked](const Values& depth, const Values& deepest, const Values& angle) {
    return asked("bear", 2, depth, deepest, angle);
  };
  out.lost = [asked](const Values& deepest) { return asked("lost", 1, deepest); };
  out.along_base_normal = along_base_normal;
  out.bends = copied(bends);
  self.set_penetration(out);
}

nb::dict sections_of(const SnowContact& contact, int k) {
  const Sections& s = contact.sections(k);
  std::vector<int> rows;
  for (int i = 0; i < s.count(); i++)
    if (s[SHARE][i] > 0.0) rows.push_back(i);
  const auto place = [&](BaseField x) {
    std::vector<double> values;
    for (int i = 0; i < s.count(); i++) values.push_back(s[GRIP_PLACE][i] + s[x][i]);
    return values;
  };
  const std::vector<double> left_place = place(LEFT_X), right_place = place(RIGHT_X);
  const std::pair<const char*, const double*> fields[] = {{"position_along_ski", s[STATION]},
                                                          {"length", s[SHARE]},
                                                          {"depth", s[DEEPEST]},
                                                          {"edge_sine", s[EDGE_SINE]},
                                                          {"left_depth", s[LEFT_DEPTH]},
                                                          {"right_depth", s[RIGHT_DEPTH]},
                                                          {"left_place", left_place.data()},
                                                          {"right_place", right_place.data()},
                                                          {"normal_force", s[FORCE]},
                                                          {"shear", s[SHEAR]},
                                                          {"left_shear", s[LEFT_SHEAR]},
                                                          {"right_shear", s[RIGHT_SHEAR]},
                                                          {"push", s[PUSH]},
                                                          {"push_across", s[PUSH_ACROSS]},
                                                          {"push_off", s[PUSH_OFF]},
                                                          {"sliding", s[SLIDING]},
                                                          {"sliding_aside", s[SLIDING_ASIDE]},
                                                          {"mu", s[MU]},
                                                          {"rub", s[RUB]},
                                                          {"rub_aside", s[RUB_ASIDE]},
                                                          {"friction_load", s[FRICTION_LOAD]},
                                                          {"strength", s[EDGE_STRENGTH]},
                                                          {"left_used", s[LEFT_USED]},
                                                          {"right_used", s[RIGHT_USED]}};
  nb::dict out;
  for (const auto& [name, field] : fields) {
    std::vector<double> values;
    for (int i : rows) values.push_back(field[i]);
    out[name] = array(std::move(values));
  }
  return out;
}

// Grooves as rows: strip, line, place in space (3), depth; of the archive first, then those under the runners.
Result tracks_of(const Snow& snow, const SnowContact& contact) {
  std::vector<double> rows;
  const auto add = [&](int strip, std::int64_t number, const Vector3& origin, const Vector3& lateral, int count,
                       const double* place, const double* depth) {
    for (int j = 0; j < count; j++) {
      rows.insert(rows.end(), {double(strip), double(number)});
      for (int a = 0; a < 3; a++) rows.push_back(origin[std::size_t(a)] + place[j] * lateral[std::size_t(a)]);
      rows.push_back(depth[j]);
    }
  };
  for (const Track& t : snow.archive.tracks()) add(t.strip, t.number, t.origin, t.lateral, t.count, t.place, t.depth);
  for (int k = 0; k < contact.runners(); k++) {
    const GrooveLines& lines = contact.lines(k);
    for (std::int64_t n = lines.first; n < lines.end; n++) {
      const int slot = lines.slot(n);
      const Ground ground = lines.ground(slot);
      if (!ground.empty())
        add(contact.strip(k), n, lines.origin(slot), lines.lateral(slot), ground.count, ground.place, ground.depth);
    }
  }
  return array(rows, {rows.size() / 6, 6});
}

nb::tuple force(SnowContact& self, const Array& position, const Array& rotation, const Array& velocity, double dt,
                const Beams& beams, const Beams& rates) {
  const Situation at = situation(self.runners(), position, rotation, &velocity, dt, beams, rates);
  std::vector<Reaction> found;
  {
    nb::gil_scoped_release free;
    found = self.force(at);
  }
  std::vector<double> wrench;
  nb::list loads;
  for (const Reaction& each : found) {
    wrench.insert(wrench.end(), each.force, each.force + 3);
    wrench.insert(wrench.end(), each.moment, each.moment + 3);
    if (beams) loads.append(array(each.beam, {each.beam.size() / 3, 3}));
  }
  return nb::make_tuple(array(wrench, {found.size(), 6}), loads);
}

void bind_laws(nb::module_& m) {
  nb::class_<FrictionLaw>(m, "FrictionLaw")
      .def(nb::init<>())
      .def_rw("constant", &FrictionLaw::constant)
      .def_rw("linear", &FrictionLaw::linear)
      .def_rw("square", &FrictionLaw::square)
      .def_rw("film", &FrictionLaw::film)
      .def_rw("film_speed", &FrictionLaw::film_speed)
      .def_rw("stick", &FrictionLaw::stick)
      .def_rw("is_vector", &FrictionLaw::is_vector)
      .def_rw("acts_across", &FrictionLaw::acts_across);

  nb::class_<ShearLaw>(m, "ShearLaw")
      .def(nb::init<>())
      .def_rw("decrease", &ShearLaw::decrease)
      .def_rw("cuts", &ShearLaw::cuts)
      .def_rw("friction_angle", &ShearLaw::friction_angle)
      .def_rw("least_plane", &ShearLaw::least_plane)
      .def_rw("residual_ratio", &ShearLaw::residual_ratio)
      .def_rw("weakening", &ShearLaw::weakening)
      .def_rw("loaded_only", &ShearLaw::loaded_only);

  nb::class_<RateLaw>(m, "RateLaw")
      .def(nb::init<>())
      .def_rw("damping", &RateLaw::damping)
      .def_rw("delayed_share", &RateLaw::delayed_share)
      .def_rw("retardation", &RateLaw::retardation)
      .def_rw("spacing", &RateLaw::spacing);
}

void bind_snow(nb::module_& m) {
  nb::class_<Grid>(m, "Grid").def(nb::init<double>()).def("at", [](const Grid& g, double x, double y) {
    const Grid::Value found = g.at(x, y);
    return nb::make_tuple(found.value, found.slope_x, found.slope_y);
  });
  m.def("grid", &grid);
  nb::class_<Runner>(m, "Runner");
  m.def("runner", &runner);

  nb::class_<Snow>(m, "Snow")
      .def(nb::init<>())
      .def_rw("surface", &Snow::surface)
      .def_rw("hardness", &Snow::hardness)
      .def_rw("strength", &Snow::strength)
      .def_rw("friction_share", &Snow::friction_share)
      .def_rw("strength_share", &Snow::strength_share)
      .def_rw("unloading_ratio", &Snow::unloading_ratio)
      .def_rw("shear_displacement", &Snow::shear_displacement)
      .def_rw("compaction_resistance", &Snow::compaction_resistance)
      .def_rw("friction", &Snow::friction)
      .def_rw("friction_on_base", &Snow::friction_on_base)
      .def_rw("shear", &Snow::shear)
      .def_rw("rate", &Snow::rate)
      .def_rw("knot_area", &Snow::knot_area)
      .def_rw("part_along", &Snow::part_along)
      .def_rw("part_across", &Snow::part_across);
}

void make_contact(SnowContact* at, std::shared_ptr<Snow> snow, std::vector<Runner> runners, double spacing,
                  const std::optional<std::string>& set) {
  const Kernels* chosen = set ? kernels_named(set->c_str()) : &kernels();
  if (set && chosen == nullptr)
    throw std::invalid_argument("this processor or library lacks the instruction set " + *set);
  new (at) SnowContact(std::move(snow), std::move(runners), spacing, *chosen);
}

void update(SnowContact& self, const Array& position, const Array& rotation, double dt, const Beams& beams) {
  const Situation to = situation(self.runners(), position, rotation, nullptr, dt, beams, {});
  nb::gil_scoped_release free;
  self.update(to);
}

nb::tuple tangent(SnowContact& self, const Array& position, const Array& rotation, const Array& velocity, double dt,
                  const Beams& beams, const Beams& rates) {
  const Situation at = situation(self.runners(), position, rotation, &velocity, dt, beams, rates);
  std::vector<double> stiffness, damping;
  {
    nb::gil_scoped_release free;
    self.tangent(at, stiffness, damping);
  }
  const auto count = std::size_t(self.runners());
  return nb::make_tuple(array(stiffness, {count, 6, 6}), array(damping, {count, 6, 6}));
}

void set_laws(SnowContact& self, nb::object friction, nb::object shear) {
  self.laws = PythonLaws{std::move(friction), std::move(shear)};
}

void bind_contact(nb::module_& m) {
  nb::class_<SnowContact::State>(m, "State");
  m.def("check_bytes",
        [](const nb::bytes& given) { check_bytes(static_cast<const unsigned char*>(given.data()), given.size()); });
  nb::class_<SnowContact>(m, "Contact")
      .def("__init__", &make_contact, nb::arg("snow"), nb::arg("runners"), nb::arg("spacing"),
           nb::arg("instruction_set").none() = nb::none())
      .def_prop_ro("instruction_set", [](const SnowContact& self) { return self.kernels().name; })
      .def("force", &force, nb::arg("position"), nb::arg("rotation"), nb::arg("velocity"), nb::arg("dt"),
           nb::arg("beams").none(), nb::arg("rates").none())
      .def("update", &update, nb::arg("position"), nb::arg("rotation"), nb::arg("dt"), nb::arg("beams").none())
      .def("tangent", &tangent, nb::arg("position"), nb::arg("rotation"), nb::arg("velocity"), nb::arg("dt"),
           nb::arg("beams").none(), nb::arg("rates").none())
      .def("sections", &sections_of)
      .def("tracks", [](const SnowContact& self, const Snow& snow) { return tracks_of(snow, self); })
      .def("groove_energy", &SnowContact::groove_energy)
      .def("unseen_track",
           [](const SnowContact& self) { return nb::make_tuple(self.unseen_width(), self.unseen_force()); })
      .def("elastic_energy", &SnowContact::elastic_energy)
      .def("delayed_energy", &SnowContact::delayed_energy)
      .def("state", &SnowContact::state)
      .def("restore", &SnowContact::restore)
      .def("bytes_of",
           [](const SnowContact& self, const SnowContact::State& state) {
             const Bytes found = bytes_of(self, state);
             return nb::bytes(found.data(), found.size());
           })
      .def("take_bytes",
           [](SnowContact& self, const nb::bytes& given) {
             take_bytes(self, static_cast<const unsigned char*>(given.data()), given.size());
           })
      .def("set_laws", &set_laws, nb::arg("friction").none(), nb::arg("shear").none())
      .def("set_penetration", &set_penetration);
}

}  // namespace

void bind_carve(nb::module_& m);
void bind_data(nb::module_& m);
void bind_dynamics(nb::module_& m);
void bind_kernels(nb::module_& m);
}  // namespace skisnow

NB_MODULE(_core, m) {
  nb::set_leak_warnings(false);  // a script's contact with a Python law lives as long as the interpreter
  using namespace skisnow;
  m.attr("SOURCE_HASH") = SKISNOW_SOURCE_HASH;
  m.def("instruction_sets", [] {
    nb::list names;
    for (const char* name : {"baseline", "avx2", "avx512"})
      if (kernels_named(name) != nullptr) names.append(name);
    return names;
  });

  bind_laws(m);
  bind_snow(m);
  bind_contact(m);
  bind_carve(m);
  bind_dynamics(m);
  bind_data(m);
  bind_kernels(m);
}
