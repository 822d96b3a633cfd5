// The functions of FMI 3.0 for co-simulation (fmi-standard.org), declared here as far as they are used.
#include <cstdint>
#include <string>

#include "fmi/shared_functions.hpp"

using skisnow::FMU_OK;
using skisnow::FmuInstance;
using skisnow::FmuStatus;

namespace {

using Reference = std::uint32_t;
using Logger = void (*)(void* environment, FmuStatus, const char* category, const char* message);

}  // namespace

FMI_FUNCTION const char* fmi3GetVersion() { return "3.0"; }
FMI_FUNCTION FmuStatus fmi3SetDebugLogging(void*, bool, std::size_t, const char* const*) { return FMU_OK; }

FMI_FUNCTION void* fmi3InstantiateCoSimulation(const char*, const char* token, const char* resources, bool, bool,
                                               bool events, bool, const Reference*, std::size_t, void* environment,
                                               Logger logger, void*) {
  FmuInstance::Log log;
  if (logger != nullptr)
    log = [logger, environment](FmuStatus status, const std::string& words) {
      logger(environment, status, "logStatusError", words.c_str());
    };
  return FmuInstance::make(resources, token, events ? "this FMU has no event mode" : nullptr, log);
}

FMI_FUNCTION FmuStatus fmi3EnterInitializationMode(void* c, bool, double, double start, bool, double) {
  const FmuStatus begun = of(c).set_up(start);
  return begun == FMU_OK ? of(c).enter_initialization() : begun;
}
FMI_FUNCTION FmuStatus fmi3EnterStepMode(void*) { return FMU_OK; }
FMI_FUNCTION FmuStatus fmi3GetFloat64(void* c, const Reference* reference, std::size_t count, double* value,
                                      std::size_t values) {
  if (count != values) return of(c).refuse("every variable of this model is one number");
  return of(c).get(reference, count, value);
}
FMI_FUNCTION FmuStatus fmi3SetFloat64(void* c, const Reference* reference, std::size_t count, const double* value,
                                      std::size_t values) {
  if (count != values) return of(c).refuse("every variable of this model is one number");
  return of(c).set(reference, count, value);
}

FMI_FUNCTION FmuStatus fmi3DoStep(void* c, double now, double step, bool, bool* events, bool* terminate, bool* early,
                                  double* last) {
  const FmuStatus ended = of(c).step(now, step);
  *events = *terminate = *early = false;
  *last = of(c).time();
  return ended;
}

SHARED_FUNCTIONS(fmi3, FMUState, Deserialize, std::uint8_t)

// There are no variables of other kinds; none of them is all that can be asked for.
#define NO_VARIABLES(kind, type)                                                                                 \
  FMI_FUNCTION FmuStatus fmi3Get##kind(void* c, const Reference*, std::size_t count, type*, std::size_t) {       \
    return count == 0 ? FMU_OK : of(c).refuse("all variables of this model are Float64");                        \
  }                                                                                                              \
  FMI_FUNCTION FmuStatus fmi3Set##kind(void* c, const Reference*, std::size_t count, type const*, std::size_t) { \
    return count == 0 ? FMU_OK : of(c).refuse("all variables of this model are Float64");                        \
  }
NO_VARIABLES(Float32, float)
NO_VARIABLES(Int8, std::int8_t)
NO_VARIABLES(UInt8, std::uint8_t)
NO_VARIABLES(Int16, std::int16_t)
NO_VARIABLES(UInt16, std::uint16_t)
NO_VARIABLES(Int32, std::int32_t)
NO_VARIABLES(UInt32, std::uint32_t)
NO_VARIABLES(Int64, std::int64_t)
NO_VARIABLES(UInt64, std::uint64_t)
NO_VARIABLES(Boolean, bool)
NO_VARIABLES(String, const char*)

// modelDescription.xml says that these are not offered; an importer may still look for their names.
#define NOT_OFFERED(name) \
  FMI_FUNCTION FmuStatus name(void* c, ...) { return of(c).refuse(#name " is not offered"); }
#define NO_INSTANCE(name) \
  FMI_FUNCTION void* name(...) { return nullptr; }  // NOLINT(bugprone-macro-parentheses)
NO_INSTANCE(fmi3InstantiateModelExchange)
NO_INSTANCE(fmi3InstantiateScheduledExecution)
NOT_OFFERED(fmi3GetBinary)
NOT_OFFERED(fmi3SetBinary)
NOT_OFFERED(fmi3GetClock)
NOT_OFFERED(fmi3SetClock)
NOT_OFFERED(fmi3EnterEventMode)
NOT_OFFERED(fmi3EnterConfigurationMode)
NOT_OFFERED(fmi3ExitConfigurationMode)
NOT_OFFERED(fmi3GetNumberOfVariableDependencies)
NOT_OFFERED(fmi3GetVariableDependencies)
NOT_OFFERED(fmi3GetDirectionalDerivative)
NOT_OFFERED(fmi3GetAdjointDerivative)
NOT_OFFERED(fmi3GetIntervalDecimal)
NOT_OFFERED(fmi3GetIntervalFraction)
NOT_OFFERED(fmi3GetShiftDecimal)
NOT_OFFERED(fmi3GetShiftFraction)
NOT_OFFERED(fmi3SetIntervalDecimal)
NOT_OFFERED(fmi3SetIntervalFraction)
NOT_OFFERED(fmi3SetShiftDecimal)
NOT_OFFERED(fmi3SetShiftFraction)
NOT_OFFERED(fmi3EvaluateDiscreteStates)
NOT_OFFERED(fmi3UpdateDiscreteStates)
NOT_OFFERED(fmi3EnterContinuousTimeMode)
NOT_OFFERED(fmi3CompletedIntegratorStep)
NOT_OFFERED(fmi3SetTime)
NOT_OFFERED(fmi3SetContinuousStates)
NOT_OFFERED(fmi3GetContinuousStateDerivatives)
NOT_OFFERED(fmi3GetEventIndicators)
NOT_OFFERED(fmi3GetContinuousStates)
NOT_OFFERED(fmi3GetNominalsOfContinuousStates)
NOT_OFFERED(fmi3GetNumberOfEventIndicators)
NOT_OFFERED(fmi3GetNumberOfContinuousStates)
NOT_OFFERED(fmi3GetOutputDerivatives)
NOT_OFFERED(fmi3ActivateModelPartition)
