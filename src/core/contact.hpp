// Any number of runners in one snow: forces at a pose without changing the snow, and the acceptance of a step.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "sections.hpp"

namespace skisnow {

// Where the runners are and how they move, one entry for each.
struct Situation {
  std::vector<Pose> poses;
  std::vector<Motion> motions;
  double dt = 0.0;  // since the last accepted pose (s)
};

// Force and moment of the snow on one runner about its boot, in the slope's axes; loads on its beam (nodes, 3).
struct Reaction {
  double force[3] = {}, moment[3] = {};
  std::vector<double> beam;
};

// Laws from outside: they may rewrite EDGE_STRENGTH, EDGE_THRUST and FRICTION of a runner's sections before forces are
// summed.
using Laws = std::function<void(int runner, Sections&)>;

class SnowContact {
 public:
  SnowContact(std::shared_ptr<Snow> snow, std::vector<Runner> runners, double spacing, const Kernels& kernels);

  int runners() const { return int(runners_.size()); }
  const Runner& runner(int k) const { return runners_[std::size_t(k)]; }
  const Sections& sections(int k) const { return sections_[std::size_t(k)]; }
  const GrooveLines& lines(int k) const { return state_.lines[std::size_t(k)]; }
  int strip(int k) const { return state_.strips[std::size_t(k)]; }
  const char* instruction_set() const { return kernels_->name; }
  Laws laws;

  // Forces at a situation: the history advances from the last accepted pose on copies; the snow stays as it is.
  std::vector<Reaction> force(const Situation& at);

  // The step to a situation is accepted: the snow remembers it.
  void update(const Situation& to);

  // Minus the derivatives of each runner's force and moment by its own pose (rotation about the slope's axes at the
  // boot) and velocity: (6, 6) each, row by row, by central differences.
  void tangent(const Situation& at, std::vector<double>& stiffness, std::vector<double>& damping);

  double groove_energy() const;   // lost in grooves, those under the runners included (J)
  double elastic_energy() const;  // in the snow at the last situation looked at (J)

  // All that the contact remembers, but for the tracks of others.
  struct State {
    std::vector<GrooveLines> lines;
    std::vector<Pose> accepted;  // empty before the first update
    std::vector<int> strips;
    Archive::Mark tracks{0, 0, 0.0};
  };
  State state() const;
  void restore(const State& state);

 private:
  std::shared_ptr<Snow> snow_;
  std::vector<Runner> runners_;
  const Kernels* kernels_;
  State state_;
  std::vector<GrooveLines> trial_;
  std::vector<Sections> sections_;

  GrooveLines& history(int k, const Situation& at);
  Reaction evaluate(int k, const GrooveLines& lines, const Pose& pose, const Motion& motion);
  void march(int k, GrooveLines& lines, const Situation& to);
  void remember(int k, GrooveLines& lines, const Pose& pose);
};

}  // namespace skisnow
