// Parts of models as text, for programs without Python.
#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "bindings/arrays.hpp"
#include "fmi/model_data.hpp"

namespace skisnow {
namespace {

Fields begun(int kind, const Snow& snow, const SnowContact& contact, const Array& start) {
  Fields out;
  out.put("kind", double(kind));
  put_snow(snow, out);
  std::vector<Runner> runners;
  for (int k = 0; k < contact.runners(); k++) runners.push_back(contact.runner(k));
  put_runners(runners, contact.lines(0).spacing(), out);
  out.put("start", copied(start));
  return out;
}

std::string contact_data(const Snow& snow, const SnowContact& contact, const Array& start) {
  return begun(0, snow, contact, start).text();
}

std::string sledge_data(const Snow& snow, const SnowContact& contact, const Dynamics& dynamics, const Array& inertia,
                        double at_rest, const Array& start, int moving) {
  Fields out = begun(1, snow, contact, start);
  put_body(dynamics.body(), out);
  put_rule(dynamics.rule(), out);
  std::vector<double> pose(dynamics.state.position.begin(), dynamics.state.position.end());
  pose.insert(pose.end(), &dynamics.state.rotation[0][0], &dynamics.state.rotation[0][0] + 9);
  out.put("pose", pose);
  out.put("inertia", copied(inertia));
  out.put("at_rest", at_rest);
  out.put("moving", double(moving));
  return out.text();
}

}  // namespace

void bind_data(nb::module_& m) {
  m.def("contact_data", &contact_data);
  m.def("sledge_data", &sledge_data);
}

}  // namespace skisnow
