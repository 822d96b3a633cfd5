// Model of an FMU: variables by their numbers, and steps from one time to another.
//
// Equations: docs/how-to/other-programs.md; skisnow.interop, which writes the FMU, has the names of the variables.
#pragma once

#include <memory>
#include <optional>

#include "fmi/model_data.hpp"

namespace skisnow {

class FmuModel {
 public:
  virtual ~FmuModel() = default;

  // The time, then parameters, inputs and outputs. What may be set, may be set here.
  std::vector<double> values;
  int parameters = 0, inputs = 0;
  bool is_parameter(std::size_t place) const { return place >= 1 && place <= std::size_t(parameters); }
  bool is_input(std::size_t place) const { return place > last_parameter() && place <= last_input(); }

  // All of it as it is now; the two share nothing.
  virtual std::unique_ptr<FmuModel> copy() const = 0;
  // With the parameters and inputs that are set, at a time (s); outputs are known then.
  virtual void begin(double time) = 0;
  // From one time to another (s).
  virtual void step(double from, double to) = 0;
  // All of it as bytes, and back into a new one of the same data. Throws std::invalid_argument.
  virtual void write(ByteWriter& out) const = 0;
  virtual void read(ByteReader& in) = 0;

  static std::unique_ptr<FmuModel> of(const Fields& data);

 protected:
  void take_counts(const Fields& data, int parameters, int inputs, int outputs);
  double* parameter() { return values.data() + 1; }
  double* input() { return values.data() + 1 + parameters; }
  double* output() { return input() + inputs; }
  std::vector<double> start_;  // values as the data have them

 private:
  std::size_t last_parameter() const { return std::size_t(parameters); }
  std::size_t last_input() const { return std::size_t(parameters + inputs); }
};

// Rigid runners in snow: pose and motion in, force and moment out, of the inputs as they are at a step's beginning.
class FmuContact : public FmuModel {
 public:
  explicit FmuContact(const Fields& data);
  std::unique_ptr<FmuModel> copy() const override;
  void begin(double time) override;
  void step(double from, double to) override;
  void write(ByteWriter& out) const override;
  void read(ByteReader& in) override;

 private:
  std::shared_ptr<Snow> snow_;
  std::vector<Runner> runners_;
  double spacing_, accepted_ = 0.0;
  std::optional<SnowContact> contact_;

  Situation situation(double time);
  void take_parameters();
  void meet(double time);
};

// A sledge on flexible skis over snow: a force on it in, its motion and what the skis do to the boots out; poses of the
// boots at the end of a step in, where they move.
class FmuSledge : public FmuModel {
 public:
  explicit FmuSledge(const Fields& data);
  std::unique_ptr<FmuModel> copy() const override;
  void begin(double time) override;
  void step(double from, double to) override;
  void write(ByteWriter& out) const override;
  void read(ByteReader& in) override;

 private:
  std::shared_ptr<Snow> snow_;
  SnowContact contact_;
  Dynamics dynamics_;
  double at_rest_, begun_ = 0.0;
  std::vector<BootPose> boots_;  // where they are, if they move

  void push();
  void move_boots(double from, double to, bool at_rest);
  void tell();
};

}  // namespace skisnow
