#include "dynamics/body.hpp"

#include <algorithm>
#include <cmath>

namespace skisnow {

namespace {

constexpr int LOWER = HALF_BAND + 1;

Vector3 part(const Numbers& numbers, int first) { return vector_at(numbers.data() + first); }

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

Vector3 FlexibleSki::in_body(const Vector3& v) const {
  Vector3 out{};
  for (std::size_t c = 0; c < 3; c++) out = out + v[c] * axes[c];
  return out;
}

void FlexibleSki::fill_freedoms(double (&by_body)[BODY][BORDER_ROW]) const {
  for (std::size_t c = 0; c < 3; c++) {
    const Vector3 turning = cross(boot, axes[c]);
    for (std::size_t a = 0; a < 3; a++) {
      by_body[c][a] = by_body[c + 3][a + 3] = axes[c][a];
      by_body[c][a + 3] = turning[a], by_body[c + 3][a] = 0.0;
    }
  }
}

void FlexibleSki::add_wrench(const double* force, const double* moment, Numbers& out) const {
  const Vector3 push = in_body(vector_at(force)), turn = in_body(vector_at(moment)) + cross(boot, push);
  for (std::size_t a = 0; a < 3; a++) out[a] += push[a], out[a + 3] += turn[a];
}

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
  out.position = from.position + from.in_space(part(increment, 0));
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
  const Vector3 r = share * vector_at(rotation), v = vector_at(vector), once = cross(r, v);
  return v + once + 0.5 * cross(r, once);
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
  double momentum[BODY] = {}, bending[BODY] = {};
  for (int a = 0; a < BODY; a++)
    for (int b = 0; b < BODY; b++) momentum[a] += body.inertia[a][b] * state.rate[std::size_t(b)];
  for (int k = 0; k < layout.beams(); k++) {
    const FlexibleSki& ski = body.skis[std::size_t(k)];
    body.kernels->add_coupled(ski.coupling_columns, state.rate.data() + layout.first(k), bending);
    // gravity, and what a beam feels of the turning of the velocity
    const Vector3 pull = g + cross(v, o);
    const double pulled[BODY] = {pull[0], pull[1], pull[2], 0.0, 0.0, 0.0};
    body.kernels->add_coupling(ski.coupling_columns, pulled, 1.0, out.data() + layout.first(k));
  }
  for (int a = 0; a < BODY; a++) momentum[a] += bending[a];
  const Vector3 p = vector_at(momentum), l = vector_at(momentum + 3), b = vector_at(bending);
  const Vector3 air = air_velocity(body, state), drag = -body.drag * std::sqrt(dot(air, air)) * air;
  const Vector3 pushed = state.in_body(body.push), arm{0.0, 0.0, body.drag_height};
  const Vector3 force = body.mass * g + drag + pushed - cross(o, p) - cross(o, b);
  const Vector3 moment = cross(body.first_moment, g) + cross(arm, drag) + cross(body.push_at, pushed) - cross(o, l) -
                         cross(v, p) + cross(v, b);
  for (std::size_t a = 0; a < 3; a++) out[a] += force[a], out[a + 3] += moment[a];
}

void fill_pose(const FlexibleSki& ski, const BodyState& state, int first, Pose& out) {
  out.position = state.position + state.in_space(ski.boot);
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
  const Vector3 v = part(state.rate, 0), o = part(state.rate, 3);
  out.velocity = state.in_space(v + cross(o, ski.boot) + ski.velocity);
  out.turning = state.in_space(o + ski.turning);
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
  return body.drag * dot(v, v) * std::sqrt(dot(v, v));
}

double push_power(const Body& body, const BodyState& state) {
  return dot(body.push, state.in_space(part(state.rate, 0) + cross(part(state.rate, 3), body.push_at)));
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
