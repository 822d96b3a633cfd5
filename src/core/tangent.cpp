#include "tangent.hpp"

#include <algorithm>
#include <cmath>

namespace skisnow {

namespace {

constexpr int BAND_ROW = 11, MIDDLE = 5;

// Of one section: how the six unknowns of its element move the beam there, and what loads there do to them.
struct ElementShapes {
  double deflection[6], twist[6];

  ElementShapes(double z, double h) {
    const double y = 1.0 - z;
    const double w[6] = {y * y * (1.0 + 2.0 * z), h * z * y * y, 0.0, z * z * (3.0 - 2.0 * z), -h * z * z * y, 0.0};
    const double t[6] = {0.0, 0.0, y, 0.0, 0.0, z};
    std::copy_n(w, 6, deflection), std::copy_n(t, 6, twist);
  }
};

// Add loads on the beam at a section that follow from a change of one unknown of its element.
void add_to_band(int element, int column, const ElementShapes& shapes, double force, double moment,
                 RunnerTangent& out) {
  for (int row = 0; row < 6; row++)
    out.beam[std::size_t(BAND_ROW * (3 * element + row) + column - row + MIDDLE)] +=
        shapes.deflection[row] * force + shapes.twist[row] * moment;
}

// [local_movement] How the boot's six freedoms move the base at a section: to the left, off the snow, and in twist.
struct LocalMovement {
  double by[SectionDifferences::CHANGES][6];

  LocalMovement(const Sections& s, int i) {
    const double station = s[STATION][i], left = s[EDGE_LEFT][i], up = s[EDGE_UP][i], reach = s[EDGE_REACH][i];
    const double sp = s[TWIST_SINE][i], cp = s[TWIST_COSINE][i], twisting = reach * s[TWIST_SLOPE][i];
    const double outwards = s[FLARE][i] * reach / s[HALF_WIDTH][i];
    // the edge runs outwards and up; a way ahead meets the line with another place of it
    const double out = outwards * cp - twisting * sp, rise = s[BASE_RISE][i] - outwards * sp - twisting * cp;
    const double moves[SectionDifferences::CHANGES][6] = {
        {-out, 1.0, 0.0, -s[BASE_HEIGHT][i], -out * up, station + out * left},
        {-rise, 0.0, 1.0, 0.0, -station - rise * up, rise * left},
        {0.0, 0.0, 0.0, -1.0, 0.0, 0.0}};
    std::copy_n(&moves[0][0], 6 * SectionDifferences::CHANGES, &by[0][0]);
  }
};

// Forces stay where they are in space as the ski's axes turn, and as the boot goes away from them.
void add_turning(const Wrench& wrench, double weight, RunnerTangent& out) {
  for (int c = 0; c < 3; c++) {
    const int p = (c + 1) % 3, q = (c + 2) % 3;  // axis c × (axis p, axis q) = (axis q, - axis p)
    out.body[q][3 + c] += weight * wrench.force[p], out.body[p][3 + c] -= weight * wrench.force[q];
    out.body[3 + q][3 + c] += weight * wrench.moment[p], out.body[3 + p][3 + c] -= weight * wrench.moment[q];
    out.body[3 + q][c] += weight * wrench.force[p], out.body[3 + p][c] -= weight * wrench.force[q];
  }
}

}  // namespace

void RunnerTangent::clear(int nodes) {
  for (auto& row : body) std::fill(std::begin(row), std::end(row), 0.0);
  body_by_beam.assign(std::size_t(18 * nodes), 0.0);
  beam_by_body = body_by_beam;
  beam.assign(std::size_t(3 * BAND_ROW * nodes), 0.0);
}

void add_stiffness(const Runner& runner, const Sections& s, const SectionDifferences& minus, const Wrench& wrench,
                   double weight, RunnerTangent& out) {
  constexpr int CHANGES = SectionDifferences::CHANGES, ANSWERS = SectionDifferences::ANSWERS;
  const bool bends = runner.nodes() > 2;
  add_turning(wrench, weight, out);
  for (int i = 0; i < s.count(); i++) {
    if (!s.touches(i)) continue;
    const LocalMovement local(s, i);
    double answer[ANSWERS][CHANGES], by_boot[ANSWERS][6] = {};
    for (int r = 0; r < ANSWERS; r++)
      for (int m = 0; m < CHANGES; m++) answer[r][m] = weight * minus.column(m, r)[i];
    for (int r = 0; r < ANSWERS; r++)
      for (int m = 0; m < CHANGES; m++)
        for (int c = 0; c < 6; c++) by_boot[r][c] += answer[r][m] * local.by[m][c];
    for (int r = 0; r < 6; r++)
      for (int c = 0; c < 6; c++) out.body[r][c] += by_boot[r][c];
    if (!bends) continue;
    const int e = int(s[ELEMENT][i]);
    const ElementShapes shapes(s[IN_ELEMENT][i], s[ELEMENT_LENGTH][i]);
    for (int q = 0; q < 6; q++) {
      double* by_body = out.beam_by_body.data() + 6 * (3 * e + q);
      double* by_beam = out.body_by_beam.data() + 6 * (3 * e + q);
      for (int c = 0; c < 6; c++) by_body[c] += shapes.deflection[q] * by_boot[6][c] + shapes.twist[q] * by_boot[7][c];
      double moved[ANSWERS];
      for (int r = 0; r < ANSWERS; r++)
        moved[r] = shapes.deflection[q] * answer[r][SectionDifferences::OFF] +
                   shapes.twist[q] * answer[r][SectionDifferences::TWIST];
      for (int r = 0; r < 6; r++) by_beam[r] += moved[r];
      add_to_band(e, q, shapes, moved[6], moved[7], out);
    }
  }
}

void add_friction_damping(const Runner& runner, const Sections& s, double weight, RunnerTangent& out) {
  const bool bends = runner.nodes() > 2;
  for (int i = 0; i < s.count(); i++) {
    const double force = s[FORCE][i], rate = weight * force * s[FRICTION_SLOPE][i];
    if (!s.touches(i) || !(force > 0.0) || rate == 0.0) continue;
    const double off = s[MOMENT][i] / force, fall = s[DEPTH_FALL][i];
    const double x = s[STATION][i] + off * (s[LINE_LEFT_0][i] - fall * s[LINE_NORMAL_0][i]);
    const double y = s[EDGE_LEFT][i] + off * (s[LINE_LEFT_1][i] - fall * s[LINE_NORMAL_1][i]);
    const double z = s[EDGE_UP][i] + off * (s[LINE_LEFT_2][i] - fall * s[LINE_NORMAL_2][i]);
    const double arm = s[EDGE_REACH][i] + off * s[BASE_WIDENING][i];
    const double t0 = s[ALONG_0][i], t1 = s[ALONG_1][i], t2 = s[ALONG_2][i];
    const double along[6] = {t0, t1, t2, y * t2 - z * t1, z * t0 - x * t2, x * t1 - y * t0};
    const double twisting = -arm * (s[TWIST_SINE][i] * t1 + s[TWIST_COSINE][i] * t2);
    for (int r = 0; r < 6; r++)
      for (int c = 0; c < 6; c++) out.body[r][c] += rate * along[r] * along[c];
    if (!bends) continue;
    const int e = int(s[ELEMENT][i]);
    const ElementShapes shapes(s[IN_ELEMENT][i], s[ELEMENT_LENGTH][i]);
    for (int q = 0; q < 6; q++) {
      const double by_unknown = rate * (shapes.deflection[q] * t2 + shapes.twist[q] * twisting);
      for (int r = 0; r < 6; r++) {
        out.body_by_beam[std::size_t(6 * (3 * e + q) + r)] += by_unknown * along[r];
        out.beam_by_body[std::size_t(6 * (3 * e + q) + r)] += by_unknown * along[r];
      }
      add_to_band(e, q, shapes, by_unknown * t2, by_unknown * twisting, out);
    }
  }
}

}  // namespace skisnow
