#include "fmi/model_data.hpp"

#include <algorithm>

namespace skisnow {

namespace {

std::string of(const std::string& thing, int number, const std::string& what) {
  return thing + "." + std::to_string(number) + "." + what;
}

void put_ski(const FlexibleSki& ski, int k, Fields& out) {
  out.put(of("ski", k, "boot"), ski.boot);
  std::vector<double> axes;
  for (const Vector3& each : ski.axes) axes.insert(axes.end(), each.begin(), each.end());
  out.put(of("ski", k, "axes"), axes);
  out.put(of("ski", k, "unknown"), ski.unknown);
  out.put(of("ski", k, "mass"), ski.mass);
  out.put(of("ski", k, "stiffness"), ski.stiffness);
  out.put(of("ski", k, "coupling"), ski.coupling);
  out.put(of("ski", k, "damping"), ski.damping);
}

FlexibleSki ski_of(const Fields& data, int k) {
  FlexibleSki out;
  data.take(of("ski", k, "boot"), out.boot);
  const auto& axes = data.at(of("ski", k, "axes"), 9);
  for (std::size_t c = 0; c < 3; c++) std::copy_n(axes.begin() + long(3 * c), 3, out.axes[c].begin());
  for (double each : data.at(of("ski", k, "unknown"))) out.unknown.push_back(int(each));
  out.mass = data.at(of("ski", k, "mass"));
  out.stiffness = data.at(of("ski", k, "stiffness"), out.mass.size());
  out.coupling = data.at(of("ski", k, "coupling"), out.mass.size());
  out.damping = data.number(of("ski", k, "damping"));
  out.prepare();
  return out;
}

}  // namespace

void put_snow(const Snow& snow, Fields& out) {
  out.put("snow.surface", snow.surface.numbers());
  out.put("snow.hardness", snow.hardness.numbers());
  out.put("snow.strength", snow.strength.numbers());
  out.put("snow.friction_share", snow.friction_share.numbers());
  out.put("snow.strength_share", snow.strength_share);
  out.put("snow.unloading_ratio", snow.unloading_ratio);
  out.put("snow.shear_displacement", snow.shear_displacement);
  out.put("snow.compaction_resistance", snow.compaction_resistance ? 1.0 : 0.0);
  const FrictionLaw& mu = snow.friction;
  out.put("snow.friction", std::vector{mu.constant, mu.linear, mu.square, mu.film, mu.film_speed, mu.stick,
                                       mu.is_vector ? 1.0 : 0.0, mu.acts_across ? 1.0 : 0.0});
  out.put("snow.friction_on_base", snow.friction_on_base ? 1.0 : 0.0);
  const ShearLaw& shear = snow.shear;
  out.put("snow.shear", std::vector{shear.decrease, shear.cuts ? 1.0 : 0.0, shear.friction_angle, shear.least_plane,
                                    shear.residual_ratio, shear.weakening, shear.loaded_only ? 1.0 : 0.0});
  const RateLaw& rate = snow.rate;
  out.put("snow.rate", std::vector{rate.damping, rate.delayed_share, rate.retardation, rate.spacing});
  out.put("snow.knot_area", snow.knot_area);
  out.put("snow.parts", std::vector{snow.part_along, snow.part_across});
}

std::shared_ptr<Snow> snow_of(const Fields& data) {
  auto out = std::make_shared<Snow>();
  out->surface = Grid::of(data.at("snow.surface"));
  out->hardness = Grid::of(data.at("snow.hardness"));
  out->strength = Grid::of(data.at("snow.strength"));
  out->friction_share = Grid::of(data.at("snow.friction_share"));
  out->strength_share = data.number("snow.strength_share");
  out->unloading_ratio = data.number("snow.unloading_ratio");
  out->shear_displacement = data.number("snow.shear_displacement");
  out->compaction_resistance = data.number("snow.compaction_resistance") != 0.0;
  const auto& mu = data.at("snow.friction", 8);
  out->friction = {mu[0], mu[1], mu[2], mu[3], mu[4], mu[5], mu[6] != 0.0, mu[7] != 0.0};
  out->friction_on_base = data.number("snow.friction_on_base") != 0.0;
  const auto& shear = data.at("snow.shear", 7);
  out->shear = {shear[0], shear[1] != 0.0, shear[2], shear[3], shear[4], shear[5], shear[6] != 0.0};
  const auto& rate = data.at("snow.rate", 4);
  out->rate = {rate[0], rate[1], rate[2], rate[3]};
  out->knot_area = data.number("snow.knot_area");
  const auto& parts = data.at("snow.parts", 2);
  out->part_along = parts[0], out->part_across = parts[1];
  return out;
}

void put_runners(const std::vector<Runner>& runners, double spacing, Fields& out) {
  out.put("runners", double(runners.size()));
  out.put("spacing", spacing);
  for (int k = 0; k < int(runners.size()); k++) {
    const Runner& each = runners[std::size_t(k)];
    out.put(of("runner", k, "ends"), std::vector{each.tail, each.tip, each.reach});
    out.put(of("runner", k, "table"), each.table);
    out.put(of("runner", k, "node"), each.node);
    out.put(of("runner", k, "element"), each.element);
    const auto& edges = each.edge_shape.given();
    out.put(of("runner", k, "edges"), std::vector(edges.begin(), edges.end()));
  }
}

std::vector<Runner> runners_of(const Fields& data) {
  std::vector<Runner> out(std::size_t(data.whole("runners")));
  for (int k = 0; k < int(out.size()); k++) {
    Runner& each = out[std::size_t(k)];
    const auto& ends = data.at(of("runner", k, "ends"), 3);
    each.tail = ends[0], each.tip = ends[1], each.reach = ends[2];
    each.table = data.at(of("runner", k, "table"));
    each.places = int(each.table.size()) / 4;
    each.node = data.at(of("runner", k, "node"));
    for (double element : data.at(of("runner", k, "element"), std::size_t(each.places)))
      each.element.push_back(int(element));
    each.fill_element_rows();
    const auto& edges = data.at(of("runner", k, "edges"), 4);
    each.edge_shape = EdgeShape(edges[0], edges[1], edges[2], edges[3]);
  }
  return out;
}

void put_body(const Body& body, Fields& out) {
  out.put("body.inertia", std::vector(&body.inertia[0][0], &body.inertia[0][0] + BODY * BODY));
  out.put("body.mass", body.mass);
  out.put("body.first_moment", body.first_moment);
  out.put("body.gravity", body.gravity);
  out.put("body.drag", std::vector{body.drag, body.drag_height});
  out.put("body.skis", double(body.skis.size()));
  for (int k = 0; k < int(body.skis.size()); k++) put_ski(body.skis[std::size_t(k)], k, out);
}

Body body_of(const Fields& data) {
  Body out;
  const auto& inertia = data.at("body.inertia", BODY * BODY);
  std::copy(inertia.begin(), inertia.end(), &out.inertia[0][0]);
  out.mass = data.number("body.mass");
  data.take("body.first_moment", out.first_moment);
  data.take("body.gravity", out.gravity);
  const auto& drag = data.at("body.drag", 2);
  out.drag = drag[0], out.drag_height = drag[1];
  for (int k = 0; k < data.whole("body.skis"); k++) out.skis.push_back(ski_of(data, k));
  return out;
}

void put_rule(const StepRule& rule, Fields& out) {
  out.put("rule",
          std::vector{rule.first, rule.fixed ? 1.0 : 0.0, rule.tolerance, rule.shortest, rule.longest, rule.closeness});
}

StepRule rule_of(const Fields& data) {
  const auto& rule = data.at("rule", 6);
  return {rule[0], rule[1] != 0.0, rule[2], rule[3], rule[4], rule[5]};
}

}  // namespace skisnow
