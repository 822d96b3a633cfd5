#include "beam/runner.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace skisnow {

namespace {

// Rotation vector of a rotation matrix below half a turn.
Vector3 rotation_vector(const double (&m)[3][3]) {
  const Vector3 twice{m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1]};
  const double sine = 0.5 * std::sqrt(twice[0] * twice[0] + twice[1] * twice[1] + twice[2] * twice[2]);
  const double cosine = 0.5 * (m[0][0] + m[1][1] + m[2][2] - 1.0);
  const double factor = sine > 1e-9 ? 0.5 * std::atan2(sine, cosine) / sine : 0.5;
  return {factor * twice[0], factor * twice[1], factor * twice[2]};
}

constexpr double TABLE_STEP = 1e-3;  // (m) of the table, at most; between its rows it is linear

// A column over falling positions, straight between them, at a place within.
double between_rows(const std::vector<double>& position, const std::vector<double>& column, double place) {
  const auto behind = std::upper_bound(position.begin() + 1, position.end() - 1, place, std::greater<>());
  const auto j = std::size_t(behind - position.begin() - 1);
  const double share = (position[j] - place) / (position[j] - position[j + 1]);
  return column[j] + share * (column[j + 1] - column[j]);
}

}  // namespace

Runner Runner::of(const std::vector<double>& position, const std::vector<double>& half_width,
                  const std::vector<double>& base_height, std::vector<double> node, const EdgeShape& edge_shape) {
  Runner out;
  out.edge_shape = edge_shape;
  out.tip = position.front(), out.tail = position.back(), out.node = std::move(node);
  const int steps = std::max(2, int(std::ceil((out.tip - out.tail) / TABLE_STEP)));
  const double step = (out.tip - out.tail) / steps;
  out.places = steps + 1;
  out.reach = *std::max_element(half_width.begin(), half_width.end());
  double highest = 0.0;
  for (const double each : base_height) highest = std::max(highest, std::fabs(each));
  out.reach += highest;
  out.table.resize(std::size_t(4 * out.places));
  const auto at = [&](int row, int column) -> double& { return out.table[std::size_t(4 * row + column)]; };
  for (int i = 0; i <= steps; i++) {
    const double place = i < steps ? out.tail + i * step : out.tip;
    at(i, 0) = between_rows(position, half_width, place), at(i, 2) = between_rows(position, base_height, place);
    int e = 0;
    while (e + 2 < out.nodes() && place <= out.node[std::size_t(e + 1)]) e++;
    out.element.push_back(e);
  }
  out.fill_element_rows();
  for (int i = 0; i <= steps; i++) {  // slopes by central differences, at the ends one-sided
    const int low = std::max(i - 1, 0), high = std::min(i + 1, steps);
    for (const int column : {0, 2}) at(i, column + 1) = (at(high, column) - at(low, column)) / ((high - low) * step);
  }
  return out;
}

void Runner::fill_element_rows() {
  element_rows.clear();
  for (int e = 0; e + 1 < nodes(); e++) {
    const double front = node[std::size_t(e)], length = front - node[std::size_t(e + 1)];
    element_rows.insert(element_rows.end(), {front, length, 1.0 / length, double(e)});
  }
}

void rotation_matrix(const Vector3& v, double (&out)[3][3]) {
  const double square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2], angle = std::sqrt(square);
  const double s = angle > 1e-6 ? std::sin(angle) / angle : 1.0 - square / 6.0;
  const double c = angle > 1e-6 ? (1.0 - std::cos(angle)) / square : 0.5 - square / 24.0;
  const double cross[3][3] = {{0.0, -v[2], v[1]}, {v[2], 0.0, -v[0]}, {-v[1], v[0], 0.0}};
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++) out[a][b] = (a == b ? 1.0 - c * square : 0.0) + s * cross[a][b] + c * v[a] * v[b];
}

void interpolate(const Pose& from, const Pose& to, const Motion* at_end, double dt, double share, Pose& middle) {
  middle.beam = to.beam;
  double relative[3][3], step[3][3];
  for (int a = 0; a < 3; a++) {
    middle.position[a] = from.position[a] + share * (to.position[a] - from.position[a]);
    for (int b = 0; b < 3; b++) {
      relative[a][b] = 0.0;
      for (int c = 0; c < 3; c++) relative[a][b] += from.rotation[c][a] * to.rotation[c][b];
    }
  }
  const Vector3 way = to.position - from.position, whole = rotation_vector(relative);
  const double bent = share * (share - 1.0);
  Vector3 turn = share * whole;
  if (at_end == nullptr) {
    const Vector3 axis = whole[0] * from.axis(0) + whole[1] * from.axis(1) + whole[2] * from.axis(2);
    middle.position = middle.position + (0.5 * bent) * cross(axis, way);
  } else {  // how far the rates at the end lead beyond the way
    const Vector3& o = at_end->turning;
    middle.position = middle.position + bent * (dt * at_end->velocity - way);
    turn = turn + bent * (dt * Vector3{dot(o, to.axis(0)), dot(o, to.axis(1)), dot(o, to.axis(2))} - whole);
  }
  rotation_matrix(turn, step);
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++) {
      middle.rotation[a][b] = 0.0;
      for (int c = 0; c < 3; c++) middle.rotation[a][b] += from.rotation[a][c] * step[c][b];
    }
  const std::size_t both = std::min(from.beam.size(), to.beam.size());
  for (std::size_t i = 0; i < both; i++) middle.beam[i] = from.beam[i] + share * (to.beam[i] - from.beam[i]);
}

}  // namespace skisnow
