// Forces along and across the edge, and their sums on the runner.
#pragma once

#include "contact/pressure_kernels.hpp"

namespace skisnow::SKISNOW_LANES {

// Motion of the boot in the ski's axes.
struct BootMotion {
  double v[3], o[3];

  BootMotion(const Motion& motion, const Pose& pose) {
    for (int a = 0; a < 3; a++) {
      v[a] = o[a] = 0.0;
      for (int b = 0; b < 3; b++) {
        v[a] += pose.rotation[b][a] * motion.velocity[std::size_t(b)];
        o[a] += pose.rotation[b][a] * motion.turning[std::size_t(b)];
      }
    }
  }
};

// Force (N) of a section below which its centre of pressure is lost in rounding: it is then at the edge.
constexpr double LEAST_FORCE = 1e-6;

// The centre of pressure of a section: where it lies, and how far across the base from the ski's middle.
template <class V>
struct Centre {
  Vector<V> at;
  V arm;

  Centre(const Cut<V>& c, V force, V moment) {
    const MaskOf<V> presses = force > LEAST_FORCE;
    const V off = select(presses, moment, V{}) / select(presses, force, all<V>(1.0));
    at = {c.station + off * (c.left.x - c.fall * c.normal.x), c.grip_left + off * (c.left.y - c.fall * c.normal.y),
          c.grip_up + off * (c.left.z - c.fall * c.normal.z)};
    arm = c.reach + off * c.widening;
  }
};

// Rates of the beam at the sections: of its deflection and of its twist.
template <class V>
SKISNOW_INLINE void find_beam_rates(const Motion& motion, const Base& base, int i, V& deflection, V& twist) {
  deflection = twist = V{};
  if (motion.beam.empty()) return;
  Row front[WIDTH<V>], rear[WIDTH<V>];
  for (int lane = 0; lane < WIDTH<V>; lane++) {
    const double* rate = motion.beam.data() + 3 * int(base[ELEMENT][i + lane]);
    front[lane] = load<Row>(rate), rear[lane] = load<Row>(rate + 2);
  }
  V first[ROW], second[ROW];
  transpose<V>(front, first), transpose<V>(rear, second);
  const V z = load<V>(base[IN_ELEMENT] + i);
  const Shapes<V> shape(z, load<V>(base[ELEMENT_LENGTH] + i));
  deflection =
      shape.front * first[0] + shape.front_slope * first[1] + shape.rear * second[1] + shape.rear_slope * second[2];
  twist = (1.0 - z) * first[2] + z * second[3];
}

// The direction aside of what slides: across the edge in the surface, or where friction acts on what presses on the
// base, in the base's plane at right angles to `along`.
template <class V>
Vector<V> aside_of(const Cut<V>& c, const Snow& snow) {
  if (!snow.friction_on_base) return c.across;
  const Vector<V> off_base{c.reach * c.twist_slope - c.rise * c.cp, c.sp, c.cp}, raw = cross(off_base, c.along);
  return scaled(raw, 1.0 / root(dot(raw, raw)));
}

// Way of the base over a line, along the edge and aside, from where the friction was 0. Two points give the place
// of the base: where the ski's axis passes the line, and where a point at the distance `arm` across the ski does.
template <class V>
struct Way {
  V ahead, aside;

  Way(const Cut<V>& c, const Vector<V>& to_side, V station, V place, V arm) {
    const V on = station - station_of(c), over = c.place + (arm - c.reach) / c.widening - place;
    ahead = on * c.along.x + over * dot(c.left, c.along), aside = on * to_side.x + over * dot(c.left, to_side);
  }

  static V station_of(const Cut<V>& c) { return c.from.x + (c.from.y * c.ahead.y + c.from.z * c.ahead.z) / c.ahead.x; }
};

// Coulomb's friction over μ and its load: a spring up to `full`, of the way or of the velocity; and its growth.
template <class V>
struct Rubbing {
  V along, aside, slope, skew, aside_slope;

  Rubbing(V ahead, V to_side, V full) {
    const V far = root(ahead * ahead + to_side * to_side), larger = maximum(far, full);
    const MaskOf<V> moves = larger > 0.0;
    const V per_way = select(moves, all<V>(1.0), V{}) / select(moves, larger, all<V>(1.0));
    along = ahead * per_way, aside = to_side * per_way;
    const V turns = select(far < full, V{}, per_way);
    slope = per_way - turns * along * along, skew = -turns * along * aside;
    aside_slope = per_way - turns * aside * aside;
  }

  void store_at(Sliding& out, int i, bool acts_across) const {
    const double across = acts_across ? 1.0 : 0.0;
    store(out[RUB] + i, along), store(out[RUB_ASIDE] + i, across * aside), store(out[RUB_SLOPE] + i, slope);
    store(out[RUB_SKEW] + i, across * skew), store(out[RUB_ASIDE_SLOPE] + i, across * aside_slope);
  }
};

// [slide] Velocity at the centre of pressure along the edge and aside, and the law's μ; the share of it in use by the
// way since the base stuck, or where a line was not under it yet, by the way of this step.
template <class V>
void slide(const Motion& motion, const Pose& pose, double dt, const Snow& snow, const GrooveLines& lines,
           const Base& base, const Pressures& pressure, Sliding& out) {
  const BootMotion m(motion, pose);
  const FrictionLaw& law = snow.friction;
  const V at_once = all<V>(dt > 0.0 ? law.stick / dt : 0.0);  // speed (m/s) of full friction on a new line
  for_lanes<V>(base, lines, [&](int i, int j) {
    if (!any(load<V>(base[SHARE] + i) > 0.0)) {  // beyond tip and tail
      for (int field = 0; field < SLIDING_FIELDS; field++) store(out[SlidingField(field)] + i, V{});
      return;
    }
    const Cut<V> c = Cut<V>::stored(base, i);
    const Centre<V> centre(c, load<V>(pressure[FORCE] + i), load<V>(pressure[MOMENT] + i));
    V deflecting, turning;
    find_beam_rates<V>(motion, base, i, deflecting, turning);
    turning *= centre.arm;
    const Vector<V> velocity{m.v[0] + m.o[1] * centre.at.z - m.o[2] * centre.at.y,
                             m.v[1] + m.o[2] * centre.at.x - m.o[0] * centre.at.z - c.sp * turning,
                             m.v[2] + m.o[0] * centre.at.y - m.o[1] * centre.at.x + deflecting - c.cp * turning};
    const Vector<V> aside = aside_of(c, snow);
    const double vector = law.is_vector ? 1.0 : 0.0;
    const V ahead = dot(velocity, c.along), to_side = vector * dot(velocity, aside);
    const V speed = root(ahead * ahead + to_side * to_side);
    const V film = law.film != 0.0 ? 1.0 / (1.0 + speed / law.film_speed) : V{};
    const V of_law = law.constant + speed * (law.linear + law.square * speed) + law.film * film;
    const V growth_of_law = law.linear + 2.0 * law.square * speed - law.film / law.film_speed * film * film;
    store(out[SLIDING] + i, ahead), store(out[SLIDING_ASIDE] + i, to_side);
    store(out[MU] + i, maximum(of_law, V{}));  // friction never drives the ski
    store(out[MU_GROWTH] + i, select(of_law > 0.0, growth_of_law, V{}));
    store(out[ASIDE_0] + i, aside.x), store(out[ASIDE_1] + i, aside.y), store(out[ASIDE_2] + i, aside.z);
    const MaskOf<V> stuck = load<V>(lines.values[STUCK] + j) > 0.5;
    const auto at_zero = [&](LineField field) { return load<V>(lines.values[field] + j); };
    const Way<V> way(c, aside, at_zero(STUCK_STATION), at_zero(STUCK_PLACE), at_zero(STUCK_ARM));
    const Rubbing<V> rubbing(select(stuck, way.ahead, ahead), select(stuck, vector * way.aside, to_side),
                             select(stuck, all<V>(law.stick), at_once));
    rubbing.store_at(out, i, law.is_vector && law.acts_across);
    store(out[RUB_BY_WAY] + i, select(stuck, all<V>(1.0), V{}));
  });
}

// The loads on a section: the snow's force and its moment about the grip, μ along and aside with their signs, shear
// strength, thrust and the share of the displacement in use at each edge.
template <class V>
struct Acting {
  V share, force, moment, friction, friction_aside, strength, thrust, used[2];
  V loaded = all<V>(1.0);  // share of the depth that holds an edge inwards

  // That share at a section, where the base is or near it.
  void find_used(const Snow& snow, const GrooveLines& lines, int j, const Cut<V>& c) {
    for (int k = 0; k < 2; k++) {
      used[k] = V{};
      if (!any(c.depth[k] > 0.0)) continue;
      const V now = eased(snow, lines, j, k, shear_used(snow, lines, j, c, k), strength, thrust, c.depth[k]);
      used[k] = select(c.depth[k] > 0.0, now, V{});
    }
  }
};

// [edges] What the snow holds at both edges. The wall outside an edge holds it against a motion outwards, with its
// depth e_i; against a motion inwards it is the slope of the base down to it, max(0, e_i - e_other). Together both hold
// the depth of the deeper edge, to either side. A cut is in the plane across the edge, or its thrust creates energy.
template <class V>
struct EdgeForces {
  V shear[2], upright{};        // shear of each edge; the sum's part along the base's normal
  Vector<V> force{}, moment{};  // about the boot, in the ski's axes
  V turning{};                  // moment about the ski's middle, by which the beam twists

  SKISNOW_INLINE EdgeForces(const Cut<V>& c, const Acting<V>& by, MaskOf<V> wet) {
    shear[0] = shear[1] = V{};
    const MaskOf<V> is_between = wet & c.is_between();
    if (!any(is_between)) {  // both edges would give the same bits
      const MaskOf<V> on_left = c.side > 0.0;
      const V used = within(select(on_left, by.used[0], by.used[1]), -1.0, 1.0);
      const V deep = c.shape->acts() ? maximum(V(select(on_left, c.depth[0], c.depth[1])), V{}) : c.deepest;
      const MaskOf<V> inwards = select(on_left, used, V(-used)) > 0.0;
      const V area = select(inwards, V(deep * by.loaded), deep) * by.share;
      const V all_shear = select(wet, by.strength * area * used, V{});
      shear[0] = select(on_left, all_shear, V{}), shear[1] = select(on_left, V{}, all_shear);
      add(c, {c.reach, c.grip_left, c.grip_up, c.across}, all_shear,
          select(wet, by.thrust * area * absolute(used), V{}));
      return;
    }
    for (int k = 0; k < 2; k++) {
      const V used = within(by.used[k], -1.0, 1.0), deep = maximum(c.depth[k], V{});
      const V slope = by.loaded * maximum(V(deep - maximum(c.depth[1 - k], V{})), V{});
      const V area = select(k == 0 ? used > 0.0 : used < 0.0, slope, deep) * by.share;
      shear[k] = select(wet, by.strength * area * used, V{});
      add(c, c.edge(k), shear[k], select(wet, by.thrust * area * absolute(used), V{}));
    }
  }

 private:
  void add(const Cut<V>& c, const Edge<V>& at, V shear, V thrust) {
    const Vector<V> raw = cross(c.direction(at.reach / c.half), at.across), off = scaled(raw, 1.0 / dot(raw, c.normal));
    const Vector<V> f{shear * at.across.x + thrust * off.x, shear * at.across.y + thrust * off.y,
                      shear * at.across.z + thrust * off.z};
    const Vector<V> m = cross({c.station, at.left, at.up}, f);
    const V square = c.sp * f.y + c.cp * f.z;
    upright += square;
    force = {force.x + f.x, force.y + f.y, force.z + f.z};
    moment = {moment.x + m.x, moment.y + m.y, moment.z + m.z};
    turning -= at.reach * square;
  }
};

// The forces of one section.
template <class V>
struct Pushed {
  static constexpr int PARTS = 8;
  V shear, edge_shear[2], along, load, across, off;
  V parts[PARTS];  // force and moment about the boot in the ski's axes; force and moment on the beam

  SKISNOW_INLINE Pushed(const Cut<V>& c, const Acting<V>& by, const Snow& snow) {
    const V none{};
    const double compaction = snow.compaction_resistance ? 1.0 : 0.0;
    const MaskOf<V> wet = (by.share > 0.0) & (c.deepest > 0.0);
    const Centre<V> centre(c, by.force, by.moment);
    const V by_twist = c.twist_slope * by.moment / (1.0 - c.sine * c.sine) * c.size;
    const V resistance = (by.force * c.climb + by_twist) * compaction;
    const EdgeForces<V> edges(c, by, wet);
    shear = edges.shear[0] + edges.shear[1], edge_shear[0] = edges.shear[0], edge_shear[1] = edges.shear[1];
    const Vector<V>& n = c.normal;
    // the load of friction: a part of the pressure, and a part of the forces at the edges
    V pressing = by.force, aside = none;
    if (snow.friction_on_base) {
      pressing = by.force * (n.y * c.sp + n.z * c.cp);
      aside = maximum(edges.upright, -pressing);
    }
    load = pressing + aside;
    const V at_centre = select(wet, resistance - by.friction * pressing, none);
    const V at_grip = select(wet, -by.friction * aside, none);
    along = at_centre + at_grip;
    const Vector<V> to_side = aside_of(c, snow);
    const V aside_at_centre = -by.friction_aside * pressing, aside_at_grip = -by.friction_aside * aside;
    const V rubs_aside = select(wet, aside_at_centre + aside_at_grip, none);
    across = rubs_aside * dot(to_side, c.across), off = rubs_aside * dot(to_side, n);
    const Vector<V> a{by.force * n.x + at_centre * c.along.x + aside_at_centre * to_side.x,
                      by.force * n.y + at_centre * c.along.y + aside_at_centre * to_side.y,
                      by.force * n.z + at_centre * c.along.z + aside_at_centre * to_side.z};
    Vector<V> z = edges.force, moment = edges.moment;
    V turning = edges.turning - centre.arm * (c.sp * a.y + c.cp * a.z);
    if (snow.friction_on_base) {
      const Vector<V> f{at_grip * c.along.x + aside_at_grip * to_side.x,
                        at_grip * c.along.y + aside_at_grip * to_side.y,
                        at_grip * c.along.z + aside_at_grip * to_side.z};
      const Vector<V> m = cross({c.station, c.grip_left, c.grip_up}, f);
      z = {z.x + f.x, z.y + f.y, z.z + f.z}, moment = {moment.x + m.x, moment.y + m.y, moment.z + m.z};
      turning -= c.reach * (c.sp * f.y + c.cp * f.z);
    }
    const Vector<V> m = cross(centre.at, a);
    const V all_parts[PARTS] = {a.x + z.x,      a.y + z.y,      a.z + z.z, moment.x + m.x,
                                moment.y + m.y, moment.z + m.z, a.z + z.z, turning};
    for (int k = 0; k < PARTS; k++) parts[k] = select(wet, all_parts[k], none);
  }
};

// A section's base before it is cut, moved by a small way to the left, off the snow, or turned in twist.
template <class V>
Cut<V> displaced(const Cut<V>& base, int change, double way) {
  Cut<V> c = base;
  if (change == SectionDifferences::LEFT) c.aside = all<V>(way);
  if (change == SectionDifferences::OFF) c.height += way;
  if (change == SectionDifferences::TWIST) c.sp += way * base.cp, c.cp -= way * base.sp;
  return c;
}

// [push] All forces of the sections, summed to the wrench on the boot and the loads of the beam.
template <class V>
void push(const Snow& snow, const Base& base, const Pressures& pressure, const EdgeHold& edge, const Sliding& sliding,
          SectionForces& forces, Wrench& out) {
  Sum sums[6];
  for (int i = 0; i < base.count(); i += WIDTH<V>) {
    if (!any((load<V>(base[SHARE] + i) > 0.0) & (load<V>(base[DEEPEST] + i) > 0.0))) {
      for (int field = 0; field < FORCE_FIELDS; field++) store(forces[ForceField(field)] + i, V{});
      continue;
    }
    const Acting<V> by{load<V>(base[SHARE] + i),
                       load<V>(pressure[FORCE] + i),
                       load<V>(pressure[MOMENT] + i),
                       load<V>(sliding[MU] + i) * load<V>(sliding[RUB] + i),
                       load<V>(sliding[MU] + i) * load<V>(sliding[RUB_ASIDE] + i),
                       load<V>(edge[EDGE_STRENGTH] + i),
                       load<V>(edge[EDGE_THRUST] + i),
                       {load<V>(edge[LEFT_USED] + i), load<V>(edge[RIGHT_USED] + i)},
                       snow.shear.loaded_only ? load<V>(edge[LOADED] + i) : all<V>(1.0)};
    const Pushed<V> pushed(Cut<V>::stored(base, i), by, snow);
    for (int k = 0; k < Pushed<V>::PARTS; k++) store(forces[ForceField(FORCE_0 + k)] + i, pushed.parts[k]);
    for (int k = 0; k < 6; k++) sums[k].add(i % BLOCK, pushed.parts[k]);
    store(forces[SHEAR] + i, pushed.shear);
    for (int k = 0; k < 2; k++) store(forces[of_edge(LEFT_SHEAR, k)] + i, pushed.edge_shear[k]);
    store(forces[PUSH] + i, pushed.along);
    store(forces[PUSH_ACROSS] + i, pushed.across), store(forces[PUSH_OFF] + i, pushed.off);
    store(forces[FRICTION_LOAD] + i, pushed.load);
  }
  for (int a = 0; a < 3; a++) out.force[a] = sums[a].total(), out.moment[a] = sums[a + 3].total();
}

// Powers of the shear at the edges, of friction, and of the snow's dashpot.
template <class V>
ContactPower sum_power(const Motion& motion, const Pose& pose, const Sections& s) {
  const BootMotion m(motion, pose);
  Sum shear, friction, damping;
  for (int i = 0; i < s.count(); i += WIDTH<V>) {
    const auto column = [&](auto field) { return load<V>(s[field] + i); };
    const MaskOf<V> wet = (column(SHARE) > 0.0) & (column(DEEPEST) > 0.0);
    if (!any(wet)) continue;
    V lifting, twisting, sheared{};
    find_beam_rates<V>(motion, s.base, i, lifting, twisting);
    const Cut<V> c = Cut<V>::stored(s.base, i);
    for (int k = 0; k < 2; k++) {
      const V force = column(of_edge(LEFT_SHEAR, k));
      if (!any(force != 0.0)) continue;
      const Edge<V> edge = c.edge(k);
      const V turning = edge.reach * twisting;
      const Vector<V> velocity{m.v[0] + m.o[1] * edge.up - m.o[2] * edge.left,
                               m.v[1] + m.o[2] * c.station - m.o[0] * edge.up - c.sp * turning,
                               m.v[2] + m.o[0] * edge.left - m.o[1] * c.station + lifting - c.cp * turning};
      sheared += select(force != 0.0, V(force * dot(velocity, edge.across)), V{});
    }
    const V rubbed = column(RUB) * column(SLIDING) + column(RUB_ASIDE) * column(SLIDING_ASIDE);
    const auto add = [&](Sum& sum, V power) { sum.add(i % BLOCK, select(wet, power, V{})); };
    add(shear, sheared), add(friction, -column(MU) * rubbed * column(FRICTION_LOAD)), add(damping, column(RATE_POWER));
  }
  return {shear.total(), friction.total(), 0.0, damping.total()};
}

// [local_tangent] How the forces of each section change as the base there is moved to the left, off the snow, and
// twisted: minus the derivatives, the laws' values held. The pressure's growth is known in closed form (`press`); the
// place of the base and the directions of forces follow by differences of one step. `sense`: of the steps to the left
// and of the twist; a level base takes the mean of both.
template <class V>
void differ(const Snow& snow, const GrooveLines& lines, const Sections& s, double step, double sense, bool is_level,
            SectionDifferences& out) {
  constexpr int CHANGES = SectionDifferences::CHANGES, PARTS = Pushed<V>::PARTS;
  for_lanes<V>(s.base, lines, [&](int i, int j) {
    if (!any((load<V>(s[SHARE] + i) > 0.0) & (load<V>(s[DEEPEST] + i) > 0.0))) return;
    const Cut<V> base(s.base, i), here = Cut<V>::stored(s.base, i);
    const PressedGrowth<V> growth(s.pressure, i);
    Acting<V> by;
    by.share = load<V>(s[SHARE] + i);
    const V mu = load<V>(s[MU] + i);
    by.friction = mu * load<V>(s[RUB] + i), by.friction_aside = mu * load<V>(s[RUB_ASIDE] + i);
    if (snow.shear.loaded_only) by.loaded = load<V>(s[LOADED] + i);
    by.strength = load<V>(s[EDGE_STRENGTH] + i), by.thrust = load<V>(s[EDGE_THRUST] + i);
    for (int change = 0; change < CHANGES; change++) {
      const int sides = is_level && change != SectionDifferences::OFF ? 2 : 1;
      V parts[PARTS] = {};
      for (int side = 0; side < sides; side++) {
        const double way = (side == 0 ? 1.0 : -1.0) * (change == SectionDifferences::OFF ? step : sense * step);
        const double per_way = 1.0 / (sides * way);
        Cut<V> c = here;
        V force, moment;
        if (change == SectionDifferences::TWIST) {
          c = displaced(base, change, way);
          c.cut();
          growth.between(here, c, force, moment);
        } else {
          c.move(s.base, i, change == SectionDifferences::LEFT, way);
          growth.between_moved(here, c, force, moment);
        }
        by.force = load<V>(s[FORCE] + i) + force, by.moment = load<V>(s[MOMENT] + i) + moment;
        by.find_used(snow, lines, j, c);
        const Pushed<V> pushed(c, by, snow);
        for (int k = 0; k < PARTS; k++)
          parts[k] += per_way * (load<V>(s[ForceField(FORCE_0 + k)] + i) - pushed.parts[k]);
      }
      for (int k = 0; k < PARTS; k++) store(out.column(change, k) + i, parts[k]);
    }
  });
}

}  // namespace skisnow::SKISNOW_LANES
