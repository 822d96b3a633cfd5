// The contact behind skisnow_contact.h: checks, arrays in and out, errors as codes.
#include <algorithm>
#include <cmath>
#include <memory>
#include <new>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

#include "bindings/skisnow_contact.h"
#include "contact/contact.hpp"

using namespace skisnow;

struct skisnow_contact {
  std::shared_ptr<Snow> snow;
  double spacing;
  std::unique_ptr<SnowContact> runners;
  std::string message;
};

struct skisnow_state {
  const skisnow_contact* of;
  SnowContact::State kept;
};

namespace {

constexpr double ORTHONORMAL = 1e-9;  // by which a rotation may fail to be one

void require(bool good, const std::string& what) {
  if (!good) throw std::invalid_argument(what);
}

std::string told(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

void require_above(double value, const char* name) {
  require(std::isfinite(value) && value > 0.0, std::string(name) + " is " + told(value) + "; it must be above 0");
}

void require_least(double value, double least, const char* name) {
  require(std::isfinite(value) && value >= least,
          std::string(name) + " is " + told(value) + "; it must be at least " + told(least));
}

void require_finite(const double* values, std::size_t count, const char* name) {
  require(values != nullptr, std::string(name) + " is NULL");
  for (std::size_t i = 0; i < count; i++)
    require(std::isfinite(values[i]),
            std::string(name) + " holds a number that is not finite, at place " + std::to_string(i));
}

// Do something; what it throws becomes a code, and words.
template <class Work>
int guarded(std::string& message, const Work& work) noexcept {
  try {
    try {
      work();
      return SKISNOW_OK;
    } catch (const std::invalid_argument& wrong) {
      message = wrong.what();
      return SKISNOW_BAD_ARGUMENT;
    } catch (const std::bad_alloc&) {
      message = "out of memory";
      return SKISNOW_NO_MEMORY;
    } catch (const std::exception& wrong) {
      message = wrong.what();
      return SKISNOW_FAILED;
    }
  } catch (...) {  // no memory even for the words
    return SKISNOW_FAILED;
  }
}

// The same for a contact, which keeps the words.
template <class Work>
int guarded(skisnow_contact* contact, const Work& work) noexcept {
  return contact == nullptr ? SKISNOW_BAD_ARGUMENT : guarded(contact->message, work);
}

Grid surface_of(const skisnow_snow& given) {
  if (given.surface == nullptr) return Grid(0.0);
  require(given.surface_nx >= 1 && given.surface_ny >= 1, "surface needs one row and one column or more");
  require_above(given.surface_dx, "surface_dx"), require_above(given.surface_dy, "surface_dy");
  const auto count = std::size_t(given.surface_nx) * std::size_t(given.surface_ny);
  require_finite(given.surface, count, "surface");
  return Grid(given.surface_x0, given.surface_dx, given.surface_nx, given.surface_y0, given.surface_dy,
              given.surface_ny, {given.surface, given.surface + count}, true);
}

std::shared_ptr<Snow> snow_of(const skisnow_snow& given) {
  require_above(given.snow_hardness, "snow_hardness");
  require_least(given.failure_shear_stress, 0.0, "failure_shear_stress");
  require_least(given.unloading_ratio, 1.0, "unloading_ratio");
  require_above(given.shear_displacement, "shear_displacement");
  require_above(given.stick_displacement, "stick_displacement"), require_least(given.knot_area, 0.0, "knot_area");
  require_above(given.part_along, "part_along"), require_above(given.part_across, "part_across");
  require_above(given.spacing, "spacing"), require_above(given.friction_film_speed, "friction_film_speed");
  const double friction[] = {given.friction_constant, given.friction_linear, given.friction_square,
                             given.friction_film};
  require_finite(friction, 4, "friction");
  auto out = std::make_shared<Snow>();
  out->surface = surface_of(given);
  out->hardness = Grid(given.snow_hardness), out->strength = Grid(given.failure_shear_stress);
  out->unloading_ratio = given.unloading_ratio, out->shear_displacement = given.shear_displacement;
  out->compaction_resistance = given.compaction_resistance != 0;
  FrictionLaw& mu = out->friction;
  mu.constant = friction[0], mu.linear = friction[1], mu.square = friction[2], mu.film = friction[3];
  mu.film_speed = given.friction_film_speed, mu.stick = given.stick_displacement;
  mu.is_vector = given.friction_along_ski == 0;
  out->knot_area = given.knot_area, out->part_along = given.part_along, out->part_across = given.part_across;
  return out;
}

bool falls(const double* values, int count) {
  return std::adjacent_find(values, values + count, std::less_equal<>()) == values + count;
}

EdgeShape edges_of(const skisnow_runner& given, const std::string& name) {
  const double numbers[] = {given.base_bevel, given.edge_width, given.side_edge, given.edge_radius};
  require_finite(numbers, 4, (name + ": edges").c_str());
  require(*std::min_element(numbers, numbers + 4) >= 0.0, name + ": a number of the edges is below 0");
  const EdgeShape out(given.base_bevel, given.edge_width, given.side_edge > 0.0 ? given.side_edge : EdgeShape::SQUARE,
                      given.edge_radius);
  require(out.width(1) <= out.width(0) || out.width(1) == 0.0, name + ": edge_radius does not fit into edge_width");
  return out;
}

Runner runner_of(const skisnow_runner& given, const std::string& name) {
  require(given.positions >= 2, name + " needs two positions or more");
  const auto count = std::size_t(given.positions);
  require_finite(given.position, count, (name + ": position").c_str());
  require_finite(given.half_width, count, (name + ": half_width").c_str());
  require_finite(given.base_height, count, (name + ": base_height").c_str());
  require(falls(given.position, given.positions), name + ": positions must fall from tip to tail");
  for (std::size_t i = 0; i < count; i++) require_above(given.half_width[i], (name + ": half_width").c_str());
  std::vector<double> node{given.position[0], given.position[count - 1]};
  if (given.nodes != 0) {
    require(given.nodes >= 2 && given.node != nullptr, name + ": a beam needs two nodes or more");
    require_finite(given.node, std::size_t(given.nodes), (name + ": node").c_str());
    require(falls(given.node, given.nodes), name + ": nodes must fall from tip to tail");
    const double off = std::max(std::fabs(given.node[0] - node[0]), std::fabs(given.node[given.nodes - 1] - node[1]));
    require(off < 1e-9, name + ": nodes must begin at the tip and end at the tail");
    node.assign(given.node, given.node + given.nodes);
  }
  return Runner::of({given.position, given.position + count}, {given.half_width, given.half_width + count},
                    {given.base_height, given.base_height + count}, std::move(node), edges_of(given, name));
}

// A contact of runners on the snow that `find_snow` gives with the spacing of its lines; words of an error to
// `message`.
template <class FindSnow>
int made(skisnow_contact** contact, char* message, std::size_t size, const skisnow_runner* runner, int runners,
         const FindSnow& find_snow) {
  std::string words;
  const int result = guarded(words, [&] {
    require(contact != nullptr, "contact is NULL");
    *contact = nullptr;
    const auto [snow, spacing] = find_snow();
    require(runner != nullptr && runners >= 1, "a contact needs one runner or more");
    std::vector<Runner> shapes;
    for (int k = 0; k < runners; k++) shapes.push_back(runner_of(runner[k], "runner " + std::to_string(k)));
    auto own = std::make_unique<SnowContact>(snow, std::move(shapes), spacing, kernels());
    *contact = new skisnow_contact{snow, spacing, std::move(own), {}};
  });
  if (message != nullptr && size > 0) message[words.copy(message, size - 1)] = '\0';
  return result;
}

std::vector<double> taken(const double*& from, int nodes, const char* name) {
  if (from == nullptr) return {};
  const auto count = std::size_t(3 * nodes);
  require_finite(from, count, name);
  std::vector<double> out(from, from + count);
  from += count;
  return out;
}

void require_rotation(const double* from, int k) {
  Vector3 row[3];
  double off = 0.0;
  for (int a = 0; a < 3; a++) row[a] = vector_at(from + 9 * k + 3 * a);
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++) off = std::max(off, std::fabs(dot(row[a], row[b]) - (a == b ? 1.0 : 0.0)));
  require(off < ORTHONORMAL && dot(row[0], cross(row[1], row[2])) > 0.0,
          "rotation of runner " + std::to_string(k) + " is none");
}

Situation situation(const SnowContact& contact, const double* position, const double* rotation, const double* velocity,
                    double dt, const double* beams, const double* rates) {
  const auto count = std::size_t(contact.runners());
  require_finite(position, 3 * count, "position"), require_finite(rotation, 9 * count, "rotation");
  require_least(dt, 0.0, "dt");
  if (velocity != nullptr) require_finite(velocity, 6 * count, "velocity");
  std::vector<std::vector<double>> bends, moves;
  for (int k = 0; k < contact.runners(); k++) {
    require_rotation(rotation, k);
    bends.push_back(taken(beams, contact.runner(k).nodes(), "beams"));
    moves.push_back(taken(rates, contact.runner(k).nodes(), "rates"));
  }
  return situation_of(position, rotation, velocity, dt, std::move(bends), std::move(moves));
}

}  // namespace

const char* skisnow_contact_sources(void) { return SKISNOW_SOURCE_HASH; }

void skisnow_snow_defaults(skisnow_snow* snow) {
  if (snow == nullptr) return;
  const Snow usual;
  const FrictionLaw& mu = usual.friction;
  *snow = {};
  snow->friction_film_speed = mu.film_speed, snow->stick_displacement = mu.stick;
  snow->shear_displacement = usual.shear_displacement;
  snow->compaction_resistance = usual.compaction_resistance ? 1 : 0;
  snow->knot_area = usual.knot_area, snow->part_along = usual.part_along, snow->part_across = usual.part_across;
  snow->spacing = LINE_SPACING;
}

int skisnow_contact_new(const skisnow_snow* snow, const skisnow_runner* runner, int runners, skisnow_contact** contact,
                        char* message, size_t size) {
  return made(contact, message, size, runner, runners, [snow] {
    require(snow != nullptr, "snow is NULL");
    return std::pair{snow_of(*snow), snow->spacing};
  });
}

int skisnow_contact_join(const skisnow_contact* other, const skisnow_runner* runner, int runners,
                         skisnow_contact** contact, char* message, size_t size) {
  return made(contact, message, size, runner, runners, [other] {
    require(other != nullptr, "other is NULL");
    return std::pair{other->snow, other->spacing};
  });
}

void skisnow_contact_free(skisnow_contact* contact) { delete contact; }

const char* skisnow_contact_message(const skisnow_contact* contact) {
  return contact == nullptr ? "contact is NULL" : contact->message.c_str();
}

int skisnow_contact_force(skisnow_contact* contact, const double* position, const double* rotation,
                          const double* velocity, double dt, const double* beams, const double* rates, double* wrench,
                          double* beam_loads) {
  return guarded(contact, [&] {
    require(wrench != nullptr, "wrench is NULL");
    require(beams != nullptr || beam_loads == nullptr, "beam_loads are asked for without beams");
    const auto found =
        contact->runners->force(situation(*contact->runners, position, rotation, velocity, dt, beams, rates));
    for (const Reaction& each : found) {
      wrench = std::copy_n(each.moment, 3, std::copy_n(each.force, 3, wrench));
      if (beam_loads != nullptr) beam_loads = std::copy(each.beam.begin(), each.beam.end(), beam_loads);
    }
  });
}

int skisnow_contact_tangent(skisnow_contact* contact, const double* position, const double* rotation,
                            const double* velocity, double dt, const double* beams, const double* rates,
                            double* stiffness, double* damping) {
  return guarded(contact, [&] {
    require(stiffness != nullptr && damping != nullptr, "stiffness or damping is NULL");
    std::vector<double> by_pose, by_motion;
    contact->runners->tangent(situation(*contact->runners, position, rotation, velocity, dt, beams, rates), by_pose,
                              by_motion);
    std::copy(by_pose.begin(), by_pose.end(), stiffness);
    std::copy(by_motion.begin(), by_motion.end(), damping);
  });
}

int skisnow_contact_update(skisnow_contact* contact, const double* position, const double* rotation, double dt,
                           const double* beams) {
  return guarded(contact, [&] {
    contact->runners->update(situation(*contact->runners, position, rotation, nullptr, dt, beams, nullptr));
  });
}

int skisnow_contact_save(skisnow_contact* contact, skisnow_state** state) {
  if (contact == nullptr || state == nullptr) return SKISNOW_BAD_ARGUMENT;
  *state = nullptr;
  return guarded(contact->message, [&] { *state = new skisnow_state{contact, contact->runners->state()}; });
}

int skisnow_contact_load(skisnow_contact* contact, const skisnow_state* state) {
  return guarded(contact, [&] {
    require(state != nullptr, "state is NULL");
    require(state->of == contact, "state is another contact's");
    contact->runners->restore(state->kept);
  });
}

void skisnow_state_free(skisnow_state* state) { delete state; }

int skisnow_contact_state_size(skisnow_contact* contact, size_t* size) {
  return guarded(contact, [&] {
    require(size != nullptr, "size is NULL");
    *size = bytes_of(*contact->runners, contact->runners->state()).size();
  });
}

int skisnow_contact_state_write(skisnow_contact* contact, unsigned char* bytes, size_t size) {
  return guarded(contact, [&] {
    require(bytes != nullptr, "bytes is NULL");
    const Bytes state = bytes_of(*contact->runners, contact->runners->state());
    require(size >= state.size(),
            "the state takes " + std::to_string(state.size()) + " bytes; there is room for " + std::to_string(size));
    std::copy(state.begin(), state.end(), bytes);
  });
}

int skisnow_contact_state_read(skisnow_contact* contact, const unsigned char* bytes, size_t size) {
  return guarded(contact, [&] { take_bytes(*contact->runners, bytes, size); });
}
