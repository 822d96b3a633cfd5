// One instance of an FMU, by whichever of the two standards it is asked: what may be done when, and errors as words.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "fmi/fmu_model.hpp"

namespace skisnow {

#if defined(_WIN32)
#define FMI_FUNCTION extern "C" __declspec(dllexport)
#else
#define FMI_FUNCTION extern "C" __attribute__((visibility("default")))
#endif

// Both standards number them so.
enum FmuStatus : int { FMU_OK = 0, FMU_DISCARD = 2, FMU_ERROR = 3, FMU_FATAL = 4 };

class FmuInstance {
 public:
  using Log = std::function<void(FmuStatus, const std::string&)>;

  // From the folder of the FMU's resources; throws where its data are not those that `token` names.
  FmuInstance(const std::string& resources, const std::string& token, Log log);
  // The same, or null after a line in the log. `objection`: to what an importer asks for, or null.
  static FmuInstance* make(const char* resources, const char* token, const char* objection, const Log& log);

  FmuStatus set_up(double start_time);
  FmuStatus enter_initialization();
  FmuStatus exit_initialization();
  FmuStatus step(double from, double length);
  FmuStatus terminate();
  FmuStatus reset();
  FmuStatus get(const unsigned* reference, std::size_t count, double* value) const;
  FmuStatus set(const unsigned* reference, std::size_t count, const double* value);
  double time() const { return model_->values[0]; }

  enum class Stage { INSTANTIATED, INITIALIZING, STEPPING, TERMINATED, FAILED };
  struct State {
    std::unique_ptr<FmuModel> model;
    Stage stage;
    double start_time;
  };
  // States as both standards hand them over: pointers without a type.
  FmuStatus keep(void** state) const;  // into *state, where that is one already
  FmuStatus take(const void* state);
  static FmuStatus free_state(void** state);
  // A state as bytes, and back into a new one, of any instance of the same FMU.
  FmuStatus size(const void* state, std::size_t* size) const;
  FmuStatus write(const void* state, void* to, std::size_t size) const;
  FmuStatus read(const void* bytes, std::size_t size, void** state) const;
  FmuStatus refuse(const std::string& what) const;  // an error, in words

 private:
  std::uint64_t token_;  // its digest
  Fields data_;
  std::unique_ptr<FmuModel> model_;
  Stage stage_ = Stage::INSTANTIATED;
  double start_time_ = 0.0;
  Log log_;

  template <class Work>
  FmuStatus guarded(const Work& work) const noexcept;
  void require(Stage stage, const char* what) const;
  FmuStatus change(Stage from, Stage to, const char* what);
  Bytes bytes(const void* state) const;
  static void replace(void** state, std::unique_ptr<State> by);
};

}  // namespace skisnow
