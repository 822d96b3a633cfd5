// The dynamics in Python: plain arrays in and out. The package skisnow.dynamics gives it names, checks and
// documentation.
#include <nanobind/nanobind.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <limits>

#include "bindings/arrays.hpp"
#include "dynamics/dynamics.hpp"

namespace skisnow {
namespace {

FlexibleSki flexible_ski(const Array& boot, const Array& axes, const Array& unknown, const Array& mass,
                         const Array& stiffness, const Array& coupling, double damping) {
  FlexibleSki out;
  std::copy_n(boot.data(), 3, out.boot.begin());
  for (int c = 0; c < 3; c++) std::copy_n(axes.data() + 3 * c, 3, out.axes[c].begin());
  for (std::size_t i = 0; i < unknown.size(); i++) out.unknown.push_back(int(unknown.data()[i]));
  out.mass = copied(mass), out.stiffness = copied(stiffness), out.coupling = copied(coupling);
  out.damping = damping;
  out.prepare();
  return out;
}

Body body(const Array& inertia, double mass, const Array& first_moment, std::vector<FlexibleSki> skis,
          const Array& gravity, double drag, double drag_height) {
  Body out;
  std::copy_n(inertia.data(), 36, &out.inertia[0][0]);
  out.mass = mass;
  out.first_moment = vector_at(first_moment.data()), out.gravity = vector_at(gravity.data());
  out.skis = std::move(skis);
  out.drag = drag, out.drag_height = drag_height;
  return out;
}

// Rows of (skis, 38), one for each boot: start and end (s), and its poses there as 18 numbers.
void move_boots(Dynamics& self, const Array& motions) {
  std::vector<BootMotion> out;
  for (const double* row = motions.data(); row != motions.data() + motions.size(); row += 38) {
    BootPose ends[2];
    for (std::size_t i = 0; i < 12; i++) ends[i / 6][i % 6] = vector_at(row + 2 + 3 * i);
    out.push_back(BootMotion::between(row[0], row[1], ends[0], ends[1]));
  }
  self.move_boots(std::move(out));
}

void set_push(Dynamics& self, const Array& force, const Array& at) {
  self.set_push(vector_at(force.data()), vector_at(at.data()));
}

// Motion of a boot against the body: place, rows of the axes, velocity and angular velocity.
void add_boot(const FlexibleSki& ski, std::vector<double>& out) {
  for (const Vector3* each : {&ski.boot, &ski.axes[0], &ski.axes[1], &ski.axes[2], &ski.velocity, &ski.turning})
    out.insert(out.end(), each->begin(), each->end());
}

// Of all boots, (skis, 18).
Result boots(const Dynamics& self) {
  std::vector<double> all;
  for (int k = 0; k < self.layout().beams(); k++) add_boot(self.stage(k), all);
  return array(std::move(all), {std::size_t(self.layout().beams()), 18});
}

void set_pose(Dynamics& self, const Array& position, const Array& rotation) {
  std::copy_n(position.data(), 3, self.state.position.begin());
  std::copy_n(rotation.data(), 9, &self.state.rotation[0][0]);
}

// The present moment as one row: motion, energies and works, then of each ski in turn its forces on the whole, depth
// and forces along it, bend, boot, and force and moment on the boot (not a number where its inertia is unknown).
Result moment_of(const Dynamics& self) {
  const auto& state = self.state;
  const Energies e = self.total_energies();
  const SnowStore& s = self.snow_store();
  const SnowAccount& l = self.snow_losses();
  std::vector<double> out{self.time};
  const auto add = [&](const auto* from, std::size_t count) { out.insert(out.end(), from, from + count); };
  add(state.position.data(), 3), add(&state.rotation[0][0], 9), add(state.rate.data(), BODY);
  for (const double each : {e.kinetic, e.potential, e.elastic, s.pressure, s.shear, s.friction, s.delayed,
                            l.penetration.total, l.shear.total, l.friction.total, l.rate.total, l.owed()})
    out.push_back(each);
  const Work& w = self.work();
  for (const double each : {w.shear, w.friction, w.normal, w.drag, w.damping, w.snow_damping, w.boots, w.push})
    out.push_back(each);
  for (int k = 0; k < self.layout().beams(); k++) {
    const Along& along = self.along(k);
    add(along.push, 3);
    for (const auto* each : {&along.depth, &along.force, &along.shear}) add(each->data(), each->size());
    add(state.bend.data() + self.layout().first(k), std::size_t(self.layout().size(k)));
    add_boot(self.stage(k), out);
    if (const Vector3* wrench = self.boot_wrench(k))
      add(wrench[0].data(), 3), add(wrench[1].data(), 3);
    else
      out.insert(out.end(), BODY, std::numeric_limits<double>::quiet_NaN());
  }
  return array(std::move(out));
}

nb::tuple counts_of(const Dynamics& self) {
  const Counts& c = self.counts();
  return nb::make_tuple(c.steps, c.rejected, c.looks, c.factored, c.iterations);
}

void bind_body(nb::module_& m) {
  nb::class_<FlexibleSki>(m, "FlexibleSki");
  m.def("flexible_ski", &flexible_ski);
  nb::class_<Body>(m, "Body");
  m.def("body", &body);
  nb::class_<StepRule>(m, "StepRule")
      .def(nb::init<>())
      .def_rw("first", &StepRule::first)
      .def_rw("fixed", &StepRule::fixed)
      .def_rw("tolerance", &StepRule::tolerance)
      .def_rw("shortest", &StepRule::shortest)
      .def_rw("longest", &StepRule::longest)
      .def_rw("closeness", &StepRule::closeness);
}

void bind_motion(nb::class_<Dynamics>& bound) {
  bound
      .def("set_velocity",
           [](Dynamics& self, const Array& rate) { std::copy_n(rate.data(), 6, self.state.rate.begin()); })
      .def_prop_ro(
          "position",
          [](const Dynamics& self) { return array({self.state.position.begin(), self.state.position.end()}, {3}); },
          nb::rv_policy::automatic)
      .def_prop_ro(
          "rotation",
          [](const Dynamics& self) {
            return array({&self.state.rotation[0][0], &self.state.rotation[0][0] + 9}, {3, 3});
          },
          nb::rv_policy::automatic)
      .def_prop_ro(
          "velocity",
          [](const Dynamics& self) { return array({self.state.rate.begin(), self.state.rate.begin() + BODY}, {BODY}); },
          nb::rv_policy::automatic);
}

}  // namespace

void bind_dynamics(nb::module_& m) {
  bind_body(m);
  nb::class_<Dynamics> bound(m, "Dynamics");
  bound.def(nb::init<Body, SnowContact&, const StepRule&>(), nb::keep_alive<1, 3>())
      .def_rw("time", &Dynamics::time)
      .def("set_pose", &set_pose)
      .def("set_skis", [](Dynamics& self, const Array& inertia) { self.set_skis(copied(inertia)); })
      .def("move_boots", &move_boots)
      .def("hold_body", &Dynamics::hold_body)
      .def("set_push", &set_push)
      .def_prop_ro("boots", &boots, nb::rv_policy::automatic)
      .def("settle", &Dynamics::settle, nb::call_guard<nb::gil_scoped_release>())
      .def("begin", &Dynamics::begin, nb::call_guard<nb::gil_scoped_release>())
      .def(
          "advance", [](Dynamics& self, double until, long most) { return int(self.advance(until, most)); },
          nb::call_guard<nb::gil_scoped_release>())
      .def(
          "copy", [](const Dynamics& self) { return Dynamics(self); }, nb::keep_alive<0, 1>())  // same contact
      .def("assign", [](Dynamics& self, const Dynamics& other) { self = other; })
      .def_prop_ro("moment", &moment_of, nb::rv_policy::automatic)
      .def_prop_ro("touches", &Dynamics::touches)
      .def_prop_ro("next_step", &Dynamics::next_step)
      .def_prop_ro("counts", &counts_of);
  bind_motion(bound);
}

}  // namespace skisnow
