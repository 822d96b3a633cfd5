// Sums of the sections' derivatives over a runner, eight numbers of a row at once.
#pragma once

#include "contact/tangent.hpp"
#include "linear_algebra/band_kernels.hpp"

namespace skisnow::SKISNOW_LANES {

// Of one section: how the six unknowns of its element move the beam there (deflection, twist), and what loads there do
// to them.
struct ElementShapes {
  double deflection[BORDER_ROW] = {}, twist[BORDER_ROW] = {};
  int first;  // of the unknowns

  ElementShapes(const Sections& s, int i) : first(3 * int(s[ELEMENT][i])) {
    const double z = s[IN_ELEMENT][i], h = s[ELEMENT_LENGTH][i], y = 1.0 - z;
    deflection[0] = y * y * (1.0 + 2.0 * z), deflection[1] = h * z * y * y, twist[2] = y;
    deflection[3] = z * z * (3.0 - 2.0 * z), deflection[4] = -h * z * z * y, twist[5] = z;
  }
};

// [local_movement] How the boot's six freedoms move the base at a section: to the left, off the snow, and in twist. The
// edge runs outwards and up: a way ahead meets the line with another place of it.
inline void find_local_movement(const Sections& s, int i, Eight (&by)[SectionDifferences::CHANGES]) {
  const double station = s[STATION][i], left = s[EDGE_LEFT][i], up = s[EDGE_UP][i], reach = s[EDGE_REACH][i];
  const double sp = s[TWIST_SINE][i], cp = s[TWIST_COSINE][i], twisting = reach * s[TWIST_SLOPE][i];
  const double outwards = s[FLARE][i] * reach / s[HALF_WIDTH][i];
  const double out = outwards * cp - twisting * sp, rise = s[BASE_RISE][i] - outwards * sp - twisting * cp;
  by[SectionDifferences::LEFT] = Eight{-out, 1.0, 0.0, -s[BASE_HEIGHT][i], -out * up, station + out * left};
  by[SectionDifferences::OFF] = Eight{-rise, 0.0, 1.0, 0.0, -station - rise * up, rise * left};
  by[SectionDifferences::TWIST] = Eight{0.0, 0.0, 0.0, -1.0, 0.0, 0.0};
}

inline void add_to(double* row, const Eight& more) { store(row, load<Eight>(row) + more); }

// Loads on the beam, force and moment, by the element's six unknowns.
inline void add_to_band(const ElementShapes& shapes, const Eight& force, const Eight& moment, RunnerTangent& out) {
  for (int row = 0; row < 6; row++)
    add_to(out.beam.data() + BAND_ROW * (shapes.first + row) + HALF_BAND - row,
           shapes.deflection[row] * force + shapes.twist[row] * moment);
}

// [stiffness] Weighted, of all sections that touch.
inline void add_stiffness(const Sections& s, const SectionDifferences& minus, double weight, bool bends,
                          RunnerTangent& out) {
  constexpr int CHANGES = SectionDifferences::CHANGES, ANSWERS = SectionDifferences::ANSWERS;
  for (int i = 0; i < s.count(); i++) {
    if (!s.touches(i)) continue;
    double answer[CHANGES][ANSWERS];
    for (int m = 0; m < CHANGES; m++)
      for (int r = 0; r < ANSWERS; r++) answer[m][r] = weight * minus.column(m, r)[i];
    Eight local[CHANGES], by_boot[ANSWERS];
    find_local_movement(s, i, local);
    for (int r = 0; r < ANSWERS; r++)
      by_boot[r] = answer[0][r] * local[0] + answer[1][r] * local[1] + answer[2][r] * local[2];
    for (int r = 0; r < BODY; r++) add_to(out.body[r], by_boot[r]);
    if (!bends) continue;
    const ElementShapes shapes(s, i);
    const double *off = answer[SectionDifferences::OFF], *twist = answer[SectionDifferences::TWIST];
    const Eight by_off = load<Eight>(off), by_twist = load<Eight>(twist);
    for (int q = 0; q < 6; q++) {
      add_to(out.beam_by_body.data() + BORDER_ROW * (shapes.first + q),
             shapes.deflection[q] * by_boot[6] + shapes.twist[q] * by_boot[7]);
      add_to(out.body_by_beam.data() + BORDER_ROW * (shapes.first + q),
             shapes.deflection[q] * by_off + shapes.twist[q] * by_twist);
    }
    const Eight deflection = load<Eight>(shapes.deflection), twisted = load<Eight>(shapes.twist);
    add_to_band(shapes, off[6] * deflection + twist[6] * twisted, off[7] * deflection + twist[7] * twisted, out);
  }
}

// [friction_damping] Friction grows with the sliding speed.
inline void add_friction_damping(const Sections& s, double weight, bool bends, RunnerTangent& out) {
  for (int i = 0; i < s.count(); i++) {
    const double force = s[FORCE][i], rate = weight * s[FRICTION_LOAD][i] * s[FRICTION_SLOPE][i];
    if (!s.touches(i) || !(force > 0.0) || rate == 0.0) continue;
    const double off = s[MOMENT][i] / force, fall = s[DEPTH_FALL][i];
    const double at[3] = {s[STATION][i] + off * (s[LINE_LEFT_0][i] - fall * s[LINE_NORMAL_0][i]),
                          s[EDGE_LEFT][i] + off * (s[LINE_LEFT_1][i] - fall * s[LINE_NORMAL_1][i]),
                          s[EDGE_UP][i] + off * (s[LINE_LEFT_2][i] - fall * s[LINE_NORMAL_2][i])};
    const double arm = s[EDGE_REACH][i] + off * s[BASE_WIDENING][i];
    const double t0 = s[ALONG_0][i], t1 = s[ALONG_1][i], t2 = s[ALONG_2][i];
    const Eight along{t0, t1, t2, at[1] * t2 - at[2] * t1, at[2] * t0 - at[0] * t2, at[0] * t1 - at[1] * t0};
    for (int r = 0; r < BODY; r++) add_to(out.body[r], rate * along[r] * along);
    if (!bends) continue;
    const ElementShapes shapes(s, i);
    const double twisting = -arm * (s[TWIST_SINE][i] * t1 + s[TWIST_COSINE][i] * t2);
    const Eight by_unknown = rate * (load<Eight>(shapes.deflection) * t2 + load<Eight>(shapes.twist) * twisting);
    for (int q = 0; q < 6; q++) {
      add_to(out.body_by_beam.data() + BORDER_ROW * (shapes.first + q), by_unknown[q] * along);
      add_to(out.beam_by_body.data() + BORDER_ROW * (shapes.first + q), by_unknown[q] * along);
    }
    add_to_band(shapes, by_unknown * t2, by_unknown * twisting, out);
  }
}

}  // namespace skisnow::SKISNOW_LANES
