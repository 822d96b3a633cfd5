// Single stages in Python, for their tests: the derivatives of a runner's forces, and the ground of one line.
#include <nanobind/nanobind.h>

#include <algorithm>
#include <stdexcept>

#include "bindings/arrays.hpp"
#include "contact/contact.hpp"

namespace skisnow {
namespace {

// Minus the derivatives of the only runner's force and moment about the boot, both in the ski's moving axes, by a way
// movements of the boot and a rotation about it (6, 6), weighted by pose and by motion; and the wrench there (6).
nb::tuple runner_tangent(SnowContact& self, const Array& position, const Array& rotation, const Array& velocity,
                         double dt, double stiffness, double damping) {
  if (self.runners() != 1) throw std::invalid_argument("the tangent is of one runner");
  Situation at{std::vector<Pose>(1), std::vector<Motion>(1), dt};
  at.poses[0].position = vector_at(position.data());
  std::copy_n(rotation.data(), 9, &at.poses[0].rotation[0][0]);
  at.motions[0] = {vector_at(velocity.data()), vector_at(velocity.data() + 3), {}};
  self.begin(at);
  const Wrench& wrench = self.look(0, at.poses[0], at.motions[0], true);
  RunnerTangent found;
  self.find_tangent(0, at.poses[0], stiffness, damping, found);
  self.take_back();
  std::vector<double> rows, forces(wrench.force, wrench.force + 3);
  for (const auto& row : found.body) rows.insert(rows.end(), row, row + BODY);
  forces.insert(forces.end(), wrench.moment, wrench.moment + 3);
  return nb::make_tuple(array(std::move(rows), {BODY, BODY}), array(std::move(forces), {BODY}));
}

Ground ground_of(const Array& knots) {
  Ground out;
  if (knots.shape(0) > KNOTS) throw std::invalid_argument("a ground has no more knots than a line keeps");
  for (std::size_t i = 0; i < knots.shape(0); i++) out.append(knots.data()[2 * i], knots.data()[2 * i + 1]);
  return out;
}

// Knots (n, 2), place and depth, of a ground after a polyline is pressed into it; whether anything changed.
nb::tuple pressed_ground(const Array& knots, const Array& polyline) {
  Ground ground = ground_of(knots), pressed = ground_of(polyline);
  const bool changed = ground.press(pressed.place, pressed.depth, pressed.count);
  std::vector<double> out;
  for (int j = 0; j < ground.count; j++) out.insert(out.end(), {ground.place[j], ground.depth[j]});
  const std::size_t count = out.size() / 2;
  return nb::make_tuple(array(std::move(out), {count, 2}), changed);
}

}  // namespace

void bind_kernels(nb::module_& m) {
  m.def("runner_tangent", &runner_tangent, nb::arg("contact"), nb::arg("position"), nb::arg("rotation"),
        nb::arg("velocity"), nb::arg("dt"), nb::arg("stiffness"), nb::arg("damping"));
  m.def("pressed_ground", &pressed_ground, nb::arg("knots"), nb::arg("polyline"));
}

}  // namespace skisnow
