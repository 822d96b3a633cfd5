#include "tangent.hpp"

#include <algorithm>
#include <cmath>

namespace skisnow {

namespace {

constexpr int BAND_ROW = 11, MIDDLE = 5;

// Of one section: how the six unknowns of its element move the beam there, and what loads there do to them.
struct ElementShapes {
  double deflection[6], rise[6], twist[6], twist_slope[6];

  ElementShapes(double z, double h) {
    const double y = 1.0 - z;
    const double w[6] = {y * y * (1.0 + 2.0 * z), h * z * y * y, 0.0, z * z * (3.0 - 2.0 * z), -h * z * z * y, 0.0};
    const double r[6] = {6.0 * z * y / h, -y * (1.0 - 3.0 * z), 0.0, -6.0 * z * y / h, -z * (3.0 * z - 2.0), 0.0};
    const double t[6] = {0.0, 0.0, y, 0.0, 0.0, z}, s[6] = {0.0, 0.0, 1.0 / h, 0.0, 0.0, -1.0 / h};
    std::copy_n(w, 6, deflection), std::copy_n(r, 6, rise), std::copy_n(t, 6, twist), std::copy_n(s, 6, twist_slope);
  }
};

// Add loads on the beam at a section that follow from a change of one unknown of its element.
void add_to_band(int element, int column, const ElementShapes& shapes, double force, double moment,
                 RunnerTangent& out) {
  for (int row = 0; row < 6; row++)
    out.beam[std::size_t(BAND_ROW * (3 * element + row) + column - row + MIDDLE)] +=
        shapes.deflection[row] * force + shapes.twist[row] * moment;
}

}  // namespace

void RunnerTangent::clear(int nodes) {
  for (auto& row : body) std::fill(std::begin(row), std::end(row), 0.0);
  body_by_beam.assign(std::size_t(18 * nodes), 0.0);
  beam_by_body = body_by_beam;
  beam.assign(std::size_t(3 * BAND_ROW * nodes), 0.0);
}

void SectionDifferences::resize(int sections) {
  count = sections;
  values.resize(std::size_t(ANSWERS * CHANGES) * std::size_t(sections));
}

Pose changed(const Pose& pose, int change, double step) {
  Pose out = pose;
  if (change >= 6) {
    out.extra[change - 6] += step;
    return out;
  }
  if (change < 3) {
    for (std::size_t a = 0; a < 3; a++) out.position[a] += step * pose.rotation[a][change];
    return out;
  }
  const int b = (change - 3 + 1) % 3, c = (change - 3 + 2) % 3;
  for (int a = 0; a < 3; a++) {
    out.rotation[a][b] = std::cos(step) * pose.rotation[a][b] + std::sin(step) * pose.rotation[a][c];
    out.rotation[a][c] = std::cos(step) * pose.rotation[a][c] - std::sin(step) * pose.rotation[a][b];
  }
  return out;
}

void add_stiffness(const Runner& runner, const Sections& s, SectionDifferences& minus, double weight,
                   RunnerTangent& out) {
  const bool bends = runner.nodes() > 2;
  for (int i = 0; i < s.count(); i++) {
    if (!s.touches(i)) continue;
    for (int r = 0; r < 6; r++)
      for (int c = 0; c < 6; c++) out.body[r][c] += weight * minus.column(c, r)[i];
    if (!bends) continue;
    const int e = int(s[ELEMENT][i]);
    const ElementShapes shapes(s[IN_ELEMENT][i], s[ELEMENT_LENGTH][i]);
    for (int c = 0; c < 6; c++) {
      const double force = weight * minus.column(c, 6)[i], moment = weight * minus.column(c, 7)[i];
      for (int row = 0; row < 6; row++)
        out.beam_by_body[std::size_t(6 * (3 * e + row) + c)] +=
            shapes.deflection[row] * force + shapes.twist[row] * moment;
    }
    for (int q = 0; q < 6; q++) {
      const double move[4] = {shapes.deflection[q], shapes.rise[q], shapes.twist[q], shapes.twist_slope[q]};
      double answer[SectionDifferences::ANSWERS] = {};
      for (int c = 0; c < 4; c++)
        for (int r = 0; r < SectionDifferences::ANSWERS; r++) answer[r] += weight * move[c] * minus.column(6 + c, r)[i];
      for (int r = 0; r < 6; r++) out.body_by_beam[std::size_t(6 * (3 * e + q) + r)] += answer[r];
      add_to_band(e, q, shapes, answer[6], answer[7], out);
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
