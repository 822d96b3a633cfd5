// Any number of runners in one snow: forces at a pose without changing the snow, and the acceptance of a step.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "contact/bearing.hpp"
#include "contact/rate.hpp"
#include "contact/tangent.hpp"

namespace skisnow {

// Where the runners are and how they move, one entry for each.
struct Situation {
  std::vector<Pose> poses;
  std::vector<Motion> motions;
  double dt = 0.0;  // since the last accepted pose (s)
};

// One from arrays, runner by runner: position (3), rotation (3, 3), velocity (6) or null, beams and their rates.
Situation situation_of(const double* position, const double* rotation, const double* velocity, double dt,
                       std::vector<std::vector<double>> beams, std::vector<std::vector<double>> rates);

// Force and moment of the snow on one runner about its boot, in the slope's axes; loads on its beam (nodes, 3).
struct Reaction {
  double force[3] = {}, moment[3] = {};
  std::vector<double> beam;
};

// Laws from outside: they may rewrite strength, thrust and friction of a runner's sections before forces are
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
  const Kernels& kernels() const { return *kernels_; }
  Laws laws;
  void set_snow(std::shared_ptr<Snow> snow) { snow_ = std::move(snow); }  // a separate copy, with its tracks
  void set_penetration(PenetrationLaw law);  // instead of H_V and k_u, before any snow is touched

  // Forces at a situation: the history advances from the last accepted pose on copies; the snow stays as it is.
  std::vector<Reaction> force(const Situation& at);

  // The step to a situation is accepted: the snow remembers it.
  void update(const Situation& to);

  // The same for one who tries many poses for the end of a step: `begin` lets the history advance towards an end
  // foreseen, up to but without it; `look` gives the forces of one runner (in the ski's axes) at a pose there, with
  // `with_tangent` also what `find_tangent` needs;
  // `take_back` lets the snow be as before `begin`; `accept` makes it remember the end, at the pose looked at last or
  // one next to it.
  void begin(const Situation& foreseen);
  const Wrench& look(int k, const Pose& pose, const Motion& motion, bool with_tangent);
  const Wrench& wrench(int k) const { return wrenches_[std::size_t(k)]; }  // at the last look
  void take_back();
  void accept(const Situation& at);
  // Weighted sum of minus the derivatives by pose and by motion at the pose looked at last: what Newton's method needs.
  void find_tangent(int k, const Pose& pose, double stiffness, double damping, RunnerTangent& out);

  // Minus the derivatives of each runner's force and moment by its own pose (rotation about the slope's axes at the
  // boot) and velocity: (6, 6) each, row by row, by central differences.
  void tangent(const Situation& at, std::vector<double>& stiffness, std::vector<double>& damping);

  // At the situation that was looked at last.
  ContactPower power(int k, const Pose& pose, const Motion& motion) const;
  double shear_displacement() const { return snow_->shear_displacement; }
  bool touches(int k) const;  // at the situation looked at last

  // Older tracks that lay between two lines and so were not met: greatest width along a ski (m), and the greatest force
  // (N) on as much of a ski at an accepted pose, which may be missing.
  double unseen_width() const { return unseen_width_; }
  double unseen_force() const { return unseen_force_; }

  double groove_energy() const;   // lost in grooves, those under the runners included (J)
  double held_energy() const;     // in the displaced shear of the edges at the last situation looked at (J)
  double stuck_energy() const;    // in the friction of the bases that stick, at that situation (J)
  double elastic_energy() const;  // in the snow at the last situation looked at (J)
  double delayed_stored() const;  // in the springs of its delayed depth, under the runners (J)
  double delayed_energy() const { return state_.delayed_energy; }  // that its delayed depth has taken so far (J)

  // All that the contact remembers, but for the tracks of others.
  struct State {
    std::vector<GrooveLines> lines;
    std::vector<Pose> accepted;  // empty before the first update
    std::vector<int> strips;
    double time = 0.0, delayed_energy = 0.0;  // (s); (J)
    Archive::Mark tracks{0, 0, 0.0, 0.0, 0};
  };
  State state() const;
  void restore(const State& state);

  // A state as bytes, the tracks in the snow with it, for another contact of equal runners in equal snow; `read` throws
  // std::invalid_argument where they are none, and changes nothing; `take` restores the state read.
  struct Kept {
    State state;
    Archive tracks;
  };
  void write(const State& state, ByteWriter& out) const;
  Kept read(ByteReader& in) const;
  void take(Kept kept);

 private:
  std::shared_ptr<Snow> snow_;
  std::vector<Runner> runners_;
  const Kernels* kernels_;
  State state_;
  std::vector<GrooveLines> trial_;
  std::vector<Sections> sections_;
  std::vector<Wrench> wrenches_;
  SectionDifferences differences_;
  std::shared_ptr<Bearing> bearing_;  // null: the core's own law
  std::vector<RatedBase> rated_;      // one for each runner, if the snow takes time
  double dt_ = 0.0;                   // from the last accepted pose to the pose that is looked at (s)
  std::vector<std::int64_t> needed_;  // lines whose history depends on the way, the foremost first
  Column scratch_, is_needed_;        // by slot; 1 for these lines
  struct Before {                     // of one runner, what `begin` has changed
    std::int64_t first, end;
    std::vector<GrooveLines::Line> lines;
    void put_back(GrooveLines& into) const;
  };
  std::vector<Before> before_;
  bool begun_ = false;
  Pose on_way_;  // between two poses
  double unseen_width_ = 0.0, unseen_force_ = 0.0;

  std::uint64_t fingerprint() const;
  GrooveLines& history(int k, const Situation& at);
  const Wrench& evaluate(int k, const GrooveLines& lines, const Pose& pose, const Motion& motion, bool grows,
                         Sections& s);
  void differ(int k, double sense, bool is_level);
  Reaction reaction(int k, const GrooveLines& lines, const Pose& pose, const Motion& motion);
  class Standing;
  bool is_clear(int k, const Situation& at) const;
  void prepare(int k, GrooveLines& lines, const Pose& pose);
  void learn(GrooveLines& lines, int slot, double from, double to, Standing& standing);
  void weigh_unseen();
  bool strength_varies() const;
  void hold_strength(int k, GrooveLines& lines) const;
  void settle_history(int k, const Situation& at);
  void leave_lines(int k);
  void count_energy(int k, GrooveLines& lines);
  void follow_snow(int k, GrooveLines& lines) const;
  void stand(const Situation& at);
  void pass_time(double dt);
  void lay_anew(int k, const Pose& pose);
  int parts(int k, const Situation& at) const;
  void march(int k, GrooveLines& lines, const Situation& to);
  void find_needed(const GrooveLines& lines, double way, const Runner& runner, const Pose& to);
  void march_where_needed(int k, const Situation& to);
  void remember(int k, GrooveLines& lines, bool is_eased);
  void press(int k, std::int64_t line, GrooveLines& lines, bool only_deepest) const;
};

// A state of a contact sealed, and a contact taken to one. All throw std::invalid_argument, and change nothing.
void check_bytes(const unsigned char* bytes, std::size_t size);  // whether they are whole, whosever they are
Bytes bytes_of(const SnowContact& contact, const SnowContact::State& state);
void take_bytes(SnowContact& contact, const unsigned char* bytes, std::size_t size);

}  // namespace skisnow
