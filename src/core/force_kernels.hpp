// What acts along and across the edge, and the sums on the runner.
#pragma once

#include "section_kernels.hpp"

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

// The centre of pressure of a section: where it lies, and how far across the base from the ski's middle.
template <class V>
struct Centre {
  Vector<V> at;
  V arm;

  Centre(const Sections& s, int i) {
    const V force = load<V>(s[FORCE] + i), moment = load<V>(s[MOMENT] + i), fall = load<V>(s[DEPTH_FALL] + i);
    const V off = moment / select(force > 0.0, force, all<V>(1.0));
    const Vector<V> left = load3<V>(s, LINE_LEFT_0, i), normal = load3<V>(s, LINE_NORMAL_0, i);
    at = {load<V>(s[STATION] + i) + off * (left.x - fall * normal.x),
          load<V>(s[EDGE_LEFT] + i) + off * (left.y - fall * normal.y),
          load<V>(s[EDGE_UP] + i) + off * (left.z - fall * normal.z)};
    arm = load<V>(s[EDGE_REACH] + i) + off * load<V>(s[BASE_WIDENING] + i);
  }
};

// Rates of the beam at a section: of its deflection and of its twist.
inline void beam_rates(const Motion& motion, const Sections& s, int i, double& deflection, double& twist) {
  deflection = twist = 0.0;
  if (motion.beam.empty()) return;
  typedef LaneTypes<2>::Value Pair;
  const double z = s[IN_ELEMENT][i];
  const double* rate = motion.beam.data() + 3 * int(s[ELEMENT][i]);
  const Shapes<Pair> shape(all<Pair>(z), all<Pair>(s[ELEMENT_LENGTH][i]));
  deflection = shape.front[0] * rate[0] + shape.front_slope[0] * rate[1] + shape.rear[0] * rate[3] +
               shape.rear_slope[0] * rate[4];
  twist = (1.0 - z) * rate[2] + z * rate[5];
}

// [slide] Speed along the edge at the centre of pressure, and the law's μ.
template <class V>
void slide(const Motion& motion, const Pose& pose, const Snow& snow, Sections& s) {
  const BootMotion m(motion, pose);
  const FrictionLaw& law = snow.friction;
  const double fade = law.fade_speed * law.fade_speed;
  for (int i = 0; i < s.count(); i++) beam_rates(motion, s, i, s[BEAM_FORCE][i], s[BEAM_MOMENT][i]);
  for (int i = 0; i < s.count(); i += WIDTH<V>) {
    const Centre<V> centre(s, i);
    const V sp = load<V>(s[TWIST_SINE] + i), cp = load<V>(s[TWIST_COSINE] + i);
    const V deflecting = load<V>(s[BEAM_FORCE] + i), turning = load<V>(s[BEAM_MOMENT] + i) * centre.arm;
    const Vector<V> velocity{m.v[0] + m.o[1] * centre.at.z - m.o[2] * centre.at.y,
                             m.v[1] + m.o[2] * centre.at.x - m.o[0] * centre.at.z - sp * turning,
                             m.v[2] + m.o[0] * centre.at.y - m.o[1] * centre.at.x + deflecting - cp * turning};
    const V sliding = dot(velocity, load3<V>(s, ALONG_0, i)), speed = absolute(sliding);
    const V film = 1.0 / (1.0 + speed / law.film_speed), size = 1.0 / root(sliding * sliding + fade);
    const V mu = law.constant + speed * (law.linear + law.square * speed) + law.film * film;
    const V growth = law.linear + 2.0 * law.square * speed - law.film / law.film_speed * film * film;
    store(s[SLIDING] + i, sliding);
    store(s[FRICTION] + i, mu * sliding * size);
    store(s[FRICTION_SLOPE] + i, (growth * speed + mu * fade * size * size) * size);
  }
}

// [push] All forces of the sections, summed to the wrench on the boot and the loads of the beam.
template <class V>
void push(const Motion&, const Pose&, const Snow& snow, Sections& s, Wrench& out) {
  Sum sums[6];
  const double compaction = snow.compaction_resistance ? 1.0 : 0.0;
  for (int i = 0; i < s.count(); i += WIDTH<V>) {
    const int lane = i % BLOCK;
    const V share = load<V>(s[SHARE] + i), deepest = load<V>(s[DEEPEST] + i), none{};
    const MaskOf<V> wet = (share > 0.0) & (deepest > 0.0);
    const Centre<V> centre(s, i);
    const V force = load<V>(s[FORCE] + i), sine = load<V>(s[EDGE_SINE] + i);
    const V by_twist =
        load<V>(s[TWIST_SLOPE] + i) * load<V>(s[MOMENT] + i) / (1.0 - sine * sine) * load<V>(s[ALONG_SIZE] + i);
    const V resistance = (force * load<V>(s[DEPTH_CLIMB] + i) + by_twist) * compaction;
    const V along = select(wet, resistance - load<V>(s[FRICTION] + i) * force, none);
    const V used = within(load<V>(s[SHEAR_USED] + i), -1.0, 1.0), area = deepest * share;
    const V shear = select(wet, load<V>(s[EDGE_STRENGTH] + i) * area * used, none);
    const V thrust = select(wet, load<V>(s[EDGE_THRUST] + i) * area * absolute(used), none);
    const Vector<V> n = load3<V>(s, LINE_NORMAL_0, i), t = load3<V>(s, ALONG_0, i);
    const Vector<V> a{force * n.x + along * t.x, force * n.y + along * t.y, force * n.z + along * t.z};
    const Vector<V> across = load3<V>(s, ACROSS_0, i);
    const Vector<V> z{shear * across.x + thrust * n.x, shear * across.y + thrust * n.y,
                      shear * across.z + thrust * n.z};
    const Vector<V> edge{load<V>(s[STATION] + i), load<V>(s[EDGE_LEFT] + i), load<V>(s[EDGE_UP] + i)};
    const Vector<V> moment = cross(centre.at, a), edge_moment = cross(edge, z);
    const V sp = load<V>(s[TWIST_SINE] + i), cp = load<V>(s[TWIST_COSINE] + i);
    const V parts[6] = {
        a.x + z.x, a.y + z.y, a.z + z.z, moment.x + edge_moment.x, moment.y + edge_moment.y, moment.z + edge_moment.z};
    for (int c = 0; c < 6; c++) {
      const V part = select(wet, parts[c], none);
      store(s[SectionField(FORCE_0 + c)] + i, part);
      sums[c].add(lane, part);
    }
    store(s[SHEAR] + i, shear);
    store(s[PUSH] + i, along);
    store(s[BEAM_FORCE] + i, select(wet, a.z + z.z, none));
    store(s[BEAM_MOMENT] + i,
          select(wet, -centre.arm * (sp * a.y + cp * a.z) - load<V>(s[EDGE_REACH] + i) * (sp * z.y + cp * z.z), none));
  }
  for (int a = 0; a < 3; a++) out.force[a] = sums[a].total(), out.moment[a] = sums[a + 3].total();
}

}  // namespace skisnow::SKISNOW_LANES
