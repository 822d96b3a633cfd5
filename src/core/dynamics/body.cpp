#include "dynamics/body.hpp"

#include <algorithm>
#include <cmath>

namespace skisnow {

namespace {

constexpr int LOWER = HALF_BAND + 1;

Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Vector3 part(const Numbers& numbers, int first) {
  const auto i = std::size_t(first);
  return {numbers[i], numbers[i + 1], numbers[i + 2]};
}

// xᵀ A x of the numbers of one beam.
double quadratic(const Body& body, const BeamColumns& band, const double* x) {
  Numbers product(std::size_t(band.size() + BORDER_ROW), 0.0);
  body.kernels->add_band(band, x, x, 0.0, 1.0, product.data());
  double total = 0.0;
  for (int i = 0; i < band.size(); i++) total += x[i] * product[std::size_t(i)];
  return total;
}

// Rows of a `BorderedSystem` from the lower half of a symmetric band.
Column band_rows(const std::vector<double>& lower) {
  const int n = int(lower.size()) / LOWER;
  Column out(std::size_t(BAND_ROW * n), 0.0);
  for (int i = 0; i < n; i++)
    for (int j = 0; j <= std::min(i, HALF_BAND); j++)
      out[std::size_t(BAND_ROW * i + HALF_BAND - j)] = out[std::size_t(BAND_ROW * (i - j) + HALF_BAND + j)] =
          lower[std::size_t(LOWER * i + j)];
  return out;
}

// Velocity of the centre of pressure of the air.
Vector3 air_velocity(const Body& body, const BodyState& state) {
  const double high = body.drag_height;
  const Vector3 v = part(state.rate, 0), o = part(state.rate, 3);
  return {v[0] + o[1] * high, v[1] - o[0] * high, v[2]};
}

}  // namespace

void FlexibleSki::prepare() {
  mass_columns = BeamColumns(mass);
  stiffness_columns = BeamColumns(stiffness);
  coupling_columns = BeamColumns(coupling);
  mass_rows = band_rows(mass), stiffness_rows = band_rows(stiffness);
  clamp_coupling.assign(std::size_t(BORDER_ROW * size()), 0.0);
  for (std::size_t i = 0; i < std::size_t(size()); i++) {
    const double* row = coupling.data() + BODY * i;
    const Vector3 v{row[0], row[1], row[2]}, o{row[3], row[4], row[5]}, by = cross(boot, v);
    for (std::size_t c = 0; c < 3; c++)
      for (std::size_t a = 0; a < 3; a++) {
        clamp_coupling[BORDER_ROW * i + c] += axes[c][a] * v[a];
        clamp_coupling[BORDER_ROW * i + c + 3] += axes[c][a] * (o[a] - by[a]);
      }
  }
  find_free_nodes();
}

void FlexibleSki::find_free_nodes() {
  free.clear(), held_places.clear();
  const int nodes = int(unknown.size());
  const auto is_free = [&](int node) { return node >= 0 && node < nodes && unknown[std::size_t(node)] >= 0; };
  for (int j = 0; j < nodes; j++) {
    if (!is_free(j)) continue;
    if (is_free(j - 1))
      free.back().count++;
    else
      free.push_back({unknown[std::size_t(j)], j, 1});
    for (int row = 3 * j; row < 3 * j + 3; row++)
      for (int m = 0; m < 2 * HALF_BAND + 1; m++) {
        const int other = row + m - HALF_BAND;
        if (!is_free(other < 0 ? -1 : other / 3)) held_places.push_back(BAND_ROW * row + m);
      }
  }
}

Layout Body::layout() const {
  std::vector<int> sizes;
  for (const FlexibleSki& each : skis) sizes.push_back(each.size());
  return Layout(sizes);
}

BodyState::BodyState(const Layout& layout) {
  bend.assign(std::size_t(layout.length()), 0.0);
  rate = bend;
}

Vector3 BodyState::in_body(const Vector3& in_space) const {
  Vector3 out{};
  for (std::size_t a = 0; a < 3; a++)
    for (std::size_t b = 0; b < 3; b++) out[a] += rotation[b][a] * in_space[b];
  return out;
}

Vector3 BodyState::in_space(const Vector3& in_body) const {
  Vector3 out{};
  for (std::size_t a = 0; a < 3; a++)
    for (std::size_t b = 0; b < 3; b++) out[a] += rotation[a][b] * in_body[b];
  return out;
}

void move(const BodyState& from, const Numbers& increment, BodyState& out) {
  const Vector3 way = from.in_space(part(increment, 0));
  for (std::size_t a = 0; a < 3; a++) out.position[a] = from.position[a] + way[a];
  double turn[3][3];
  rotation_matrix(part(increment, 3), turn);
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++) {
      out.rotation[a][b] = 0.0;
      for (int c = 0; c < 3; c++) out.rotation[a][b] += from.rotation[a][c] * turn[c][b];
    }
  for (std::size_t i = BORDER_ROW; i < increment.size(); i++) out.bend[i] = from.bend[i] + increment[i];
}

Vector3 rotated(const double* rotation, const double* vector, double share) {
  const Vector3 r{share * rotation[0], share * rotation[1], share * rotation[2]}, v{vector[0], vector[1], vector[2]};
  const Vector3 once = cross(r, v), twice = cross(r, once);
  return {v[0] + once[0] + 0.5 * twice[0], v[1] + once[1] + 0.5 * twice[1], v[2] + once[2] + 0.5 * twice[2]};
}

void add_mass(const Body& body, const Layout& layout, const Numbers& x, double scale, Numbers& out) {
  double total[BODY] = {};
  for (int a = 0; a < BODY; a++)
    for (int b = 0; b < BODY; b++) total[a] += body.inertia[a][b] * x[std::size_t(b)];
  for (int k = 0; k < layout.beams(); k++) {
    const FlexibleSki& ski = body.skis[std::size_t(k)];
    const double* beam = x.data() + layout.first(k);
    double* to = out.data() + layout.first(k);
    body.kernels->add_band(ski.mass_columns, beam, beam, 0.0, scale, to);
    body.kernels->add_coupled(ski.coupling_columns, beam, total);
    body.kernels->add_coupling(ski.coupling_columns, x.data(), scale, to);
  }
  for (int a = 0; a < BODY; a++) out[std::size_t(a)] += scale * total[a];
}

void add_stiffness(const Body& body, const Layout& layout, const Numbers& x, const Numbers& y, double scale,
                   Numbers& out) {
  for (int k = 0; k < layout.beams(); k++) {
    const FlexibleSki& ski = body.skis[std::size_t(k)];
    const int first = layout.first(k);
    body.kernels->add_band(ski.stiffness_columns, x.data() + first, y.data() + first, ski.damping, scale,
                           out.data() + first);
  }
}

void add_forces(const Body& body, const Layout& layout, const BodyState& state, Numbers& out) {
  const Vector3 v = part(state.rate, 0), o = part(state.rate, 3), g = state.in_body(body.gravity);
  const Vector3 turning = cross(v, o);
  double momentum[BODY] = {}, bending[BODY] = {};
  for (int a = 0; a < BODY; a++)
    for (int b = 0; b < BODY; b++) momentum[a] += body.inertia[a][b] * state.rate[std::size_t(b)];
  for (int k = 0; k < layout.beams(); k++) {
    const FlexibleSki& ski = body.skis[std::size_t(k)];
    body.kernels->add_coupled(ski.coupling_columns, state.rate.data() + layout.first(k), bending);
    // gravity, and what a beam feels of the turning of the velocity
    const double pulled[BODY] = {g[0] + turning[0], g[1] + turning[1], g[2] + turning[2], 0.0, 0.0, 0.0};
    body.kernels->add_coupling(ski.coupling_columns, pulled, 1.0, out.data() + layout.first(k));
  }
  for (int a = 0; a < BODY; a++) momentum[a] += bending[a];
  const Vector3 p{momentum[0], momentum[1], momentum[2]}, l{momentum[3], momentum[4], momentum[5]};
  const Vector3 b{bending[0], bending[1], bending[2]};
  const Vector3 air = air_velocity(body, state);
  const double drag = -body.drag * std::sqrt(air[0] * air[0] + air[1] * air[1] + air[2] * air[2]);
  const Vector3 pull{drag * air[0], drag * air[1], drag * air[2]};
  const Vector3 arm{0.0, 0.0, body.drag_height};
  const Vector3 force = cross(o, p), own = cross(o, b), weight = cross(body.first_moment, g), lever = cross(arm, pull);
  const Vector3 pushed = state.in_body(body.push), pushed_lever = cross(body.push_at, pushed);
  const Vector3 gyration = cross(o, l), carried = cross(v, p), beams = cross(v, b);
  for (std::size_t a = 0; a < 3; a++) {
    out[a] += body.mass * g[a] + pull[a] - force[a] - own[a];
    out[a + 3] += weight[a] + lever[a] - gyration[a] - carried[a] + beams[a];
    out[a] += pushed[a], out[a + 3] += pushed_lever[a];
  }
}

void fill_pose(const FlexibleSki& ski, const BodyState& state, int first, Pose& out) {
  const Vector3 boot = state.in_space(ski.boot);
  for (std::size_t a = 0; a < 3; a++) out.position[a] = state.position[a] + boot[a];
  for (int c = 0; c < 3; c++) {
    const Vector3 axis = state.in_space(ski.axes[c]);
    for (std::size_t a = 0; a < 3; a++) out.rotation[a][c] = axis[a];
  }
  out.beam.resize(3 * ski.unknown.size());
  for (std::size_t j = 0; j < ski.unknown.size(); j++)
    for (std::size_t c = 0; c < 3; c++)
      out.beam[3 * j + c] = ski.unknown[j] < 0 ? 0.0 : state.bend[std::size_t(first + ski.unknown[j]) + c];
}

void fill_motion(const FlexibleSki& ski, const BodyState& state, int first, Motion& out) {
  const Vector3 v = part(state.rate, 0), o = part(state.rate, 3), by_turning = cross(o, ski.boot);
  const Vector3 &moves = ski.velocity, &turns = ski.turning;
  out.velocity = state.in_space(
      {v[0] + by_turning[0] + moves[0], v[1] + by_turning[1] + moves[1], v[2] + by_turning[2] + moves[2]});
  out.turning = state.in_space({o[0] + turns[0], o[1] + turns[1], o[2] + turns[2]});
  out.beam.resize(3 * ski.unknown.size());
  for (std::size_t j = 0; j < ski.unknown.size(); j++)
    for (std::size_t c = 0; c < 3; c++)
      out.beam[3 * j + c] = ski.unknown[j] < 0 ? 0.0 : state.rate[std::size_t(first + ski.unknown[j]) + c];
}

Energies energies(const Body& body, const Layout& layout, const BodyState& state) {
  Energies out{0.0, 0.0, 0.0};
  for (std::size_t a = 0; a < BODY; a++)
    for (std::size_t b = 0; b < BODY; b++) out.kinetic += 0.5 * state.rate[a] * body.inertia[a][b] * state.rate[b];
  const Vector3 centre = state.in_space(body.first_moment), g = state.in_body(body.gravity);
  for (std::size_t a = 0; a < 3; a++) out.potential -= body.gravity[a] * (body.mass * state.position[a] + centre[a]);
  for (int k = 0; k < layout.beams(); k++) {
    const FlexibleSki& ski = body.skis[std::size_t(k)];
    const double *rate = state.rate.data() + layout.first(k), *bend = state.bend.data() + layout.first(k);
    double momentum[BODY] = {}, lifted[BODY] = {};
    body.kernels->add_coupled(ski.coupling_columns, rate, momentum);
    body.kernels->add_coupled(ski.coupling_columns, bend, lifted);
    out.kinetic += 0.5 * quadratic(body, ski.mass_columns, rate);
    out.elastic += 0.5 * quadratic(body, ski.stiffness_columns, bend);
    for (std::size_t a = 0; a < BODY; a++) out.kinetic += momentum[a] * state.rate[a];
    for (std::size_t a = 0; a < 3; a++) out.potential -= g[a] * lifted[a];
  }
  return out;
}

double drag_power(const Body& body, const BodyState& state) {
  const Vector3 v = air_velocity(body, state);
  const double square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
  return body.drag * square * std::sqrt(square);
}

double push_power(const Body& body, const BodyState& state) {
  const Vector3 v = part(state.rate, 0), by = cross(part(state.rate, 3), body.push_at);
  const Vector3 velocity = state.in_space({v[0] + by[0], v[1] + by[1], v[2] + by[2]});
  return body.push[0] * velocity[0] + body.push[1] * velocity[1] + body.push[2] * velocity[2];
}

double damping_power(const Body& body, const Layout& layout, const BodyState& state) {
  double total = 0.0;
  for (int k = 0; k < layout.beams(); k++) {
    const FlexibleSki& ski = body.skis[std::size_t(k)];
    total += ski.damping * quadratic(body, ski.stiffness_columns, state.rate.data() + layout.first(k));
  }
  return total;
}

}  // namespace skisnow
