// Motion with boots that move: the skis as separate bodies next to the trunk, and their forces on their boots.
#include <algorithm>

#include "dynamics/dynamics.hpp"

namespace skisnow {

void Dynamics::set_skis(const std::vector<double>& inertia) {
  skis_.clear();
  trunk_ = body_;
  for (std::size_t k = 0; k < body_.skis.size(); k++) {
    skis_.emplace_back(body_.skis[k], inertia.data() + BODY * BODY * k, body_);
    skis_.back().add_to(trunk_, body_.skis[k], -1.0);
  }
  trunk_.skis.clear();
  boot_.assign(skis_.size(), {});
}

void Dynamics::move_boots(std::vector<BootMotion> motions) {
  motions_ = std::move(motions);
  place_boots(time);
}

void Dynamics::set_push(const Vector3& force, const Vector3& at) {
  body_.push = trunk_.push = force;
  body_.push_at = trunk_.push_at = at;
}

// Where the boots are at a time, and what the body is with skis there.
void Dynamics::place_boots(double when) {
  if (motions_.empty()) return;
  std::copy_n(&trunk_.inertia[0][0], BODY * BODY, &body_.inertia[0][0]);
  body_.mass = trunk_.mass;
  body_.first_moment = trunk_.first_moment;
  for (std::size_t k = 0; k < skis_.size(); k++) {
    motions_[k].set(when, body_.skis[k]);
    skis_[k].add_to(body_, body_.skis[k], 1.0);
  }
}

void Dynamics::follow_skis() {
  for (std::size_t k = 0; k < skis_.size(); k++) skis_[k].follow(body_.skis[k], next_, layout_.first(int(k)));
}

// [moving residual] What is left of the skis' equations goes to the trunk through the boots; beams keep theirs.
void Dynamics::find_moving_residual(double newest, double now, double before, bool with_tangent, Numbers& out) {
  std::fill(out.begin(), out.end(), 0.0);
  fill_end();
  follow_skis();
  counts_.looks++;
  for (std::size_t k = 0; k < skis_.size(); k++) {
    MovingSki& ski = skis_[k];
    const FlexibleSki& stage = body_.skis[k];
    ski.find_residual(contact_->look(int(k), end_.poses[k], end_.motions[k], with_tangent), newest, now, before);
    const Numbers& left = ski.residual();
    stage.add_wrench(left.data(), left.data() + 3, out);
    std::copy_n(left.data() + ski.layout().first(0), stage.size(), out.data() + layout_.first(int(k)));
  }
  add_forces(trunk_, Layout(), next_, out);
  for (std::size_t a = 0; a < BODY; a++)
    for (std::size_t b = 0; b < BODY; b++)
      out[a] -= trunk_.inertia[a][b] * (newest * next_.rate[b] - now * state.rate[b] + before * rate_before_[b]);
  if (held_) std::fill(out.begin(), out.begin() + BODY, 0.0);
}

// Force and moment of each ski on its boot at the end of a step, by the snow's wrench at the last look.
void Dynamics::feel_boots(double newest, double now, double before) {
  follow_skis();
  for (std::size_t k = 0; k < skis_.size(); k++) {
    skis_[k].find_residual(contact_->wrench(int(k)), newest, now, before);
    const Numbers& left = skis_[k].residual();
    boot_[k] = {Vector3{left[0], left[1], left[2]}, Vector3{left[3], left[4], left[5]}};
  }
}

Energies Dynamics::total_energies() const {
  if (motions_.empty()) return energies(body_, layout_, state);
  Energies out = held_ ? Energies{0.0, 0.0, 0.0} : energies(trunk_, Layout(), state);
  for (const MovingSki& ski : skis_) {
    const Energies own = energies(ski.body(), ski.layout(), ski.state());
    out.kinetic += own.kinetic;
    out.potential += own.potential;
    out.elastic += own.elastic;
  }
  return out;
}

}  // namespace skisnow
