// The functions of FMI 2.0 for co-simulation (fmi-standard.org), declared here as far as they are used.
#include <cstring>
#include <string>

#include "fmi/shared_functions.hpp"

using skisnow::FMU_DISCARD;
using skisnow::FMU_OK;
using skisnow::FmuInstance;
using skisnow::FmuStatus;

namespace {

using Logger = void (*)(void* environment, const char* name, FmuStatus, const char* category, const char* message, ...);
struct Callbacks {
  Logger logger;
  void* (*allocate)(std::size_t, std::size_t);
  void (*release)(void*);
  void (*step_finished)(void*, FmuStatus);
  void* environment;
};

constexpr int CO_SIMULATION = 1;
constexpr int LAST_SUCCESSFUL_TIME = 2, TERMINATED = 3;

// The logger's message is a format.
std::string as_format(const std::string& words) {
  std::string out;
  for (char each : words) out += each == '%' ? std::string("%%") : std::string(1, each);
  return out;
}

FmuInstance::Log log_of(const Callbacks* callbacks, const char* name) {
  if (callbacks == nullptr || callbacks->logger == nullptr) return {};
  return [logger = callbacks->logger, environment = callbacks->environment, own = std::string(name)](
             FmuStatus status, const std::string& words) {
    logger(environment, own.c_str(), status, "logStatusError", as_format(words).c_str());
  };
}

int hexadecimal(char digit) {
  const char* digits = "0123456789abcdef";
  const char* found = std::strchr(digits, digit >= 'A' && digit <= 'F' ? digit - 'A' + 'a' : digit);
  return digit == '\0' || found == nullptr ? -1 : int(found - digits);
}

// file:///a%20b, file://host/a and file:/a are paths.
std::string path_of(const std::string& uri) {
  std::string rest = uri;
  if (rest.rfind("file:", 0) == 0) {
    rest.erase(0, 5);
    if (rest.rfind("//", 0) == 0) rest.erase(0, rest.find('/', 2));
  }
  std::string out;
  for (std::size_t i = 0; i < rest.size(); i++) {
    const bool coded = rest[i] == '%' && i + 2 < rest.size();
    const int high = coded ? hexadecimal(rest[i + 1]) : -1, low = coded ? hexadecimal(rest[i + 2]) : -1;
    const bool valid = high >= 0 && low >= 0;
    out += valid ? char(16 * high + low) : rest[i];
    if (valid) i += 2;
  }
  return out;
}

}  // namespace

FMI_FUNCTION const char* fmi2GetTypesPlatform() { return "default"; }
FMI_FUNCTION const char* fmi2GetVersion() { return "2.0"; }
FMI_FUNCTION FmuStatus fmi2SetDebugLogging(void*, int, std::size_t, const char* const*) { return FMU_OK; }

FMI_FUNCTION void* fmi2Instantiate(const char* name, int kind, const char* token, const char* resources,
                                   const Callbacks* callbacks, int, int) {
  const std::string folder = path_of(resources == nullptr ? "" : resources);
  return FmuInstance::make(resources == nullptr ? nullptr : folder.c_str(), token,
                           kind == CO_SIMULATION ? nullptr : "this FMU is for co-simulation only",
                           log_of(callbacks, name == nullptr ? "" : name));
}

FMI_FUNCTION FmuStatus fmi2SetupExperiment(void* c, int, double, double start, int, double) {
  return of(c).set_up(start);
}
FMI_FUNCTION FmuStatus fmi2EnterInitializationMode(void* c) { return of(c).enter_initialization(); }
FMI_FUNCTION FmuStatus fmi2GetReal(void* c, const unsigned* reference, std::size_t count, double* value) {
  return of(c).get(reference, count, value);
}
FMI_FUNCTION FmuStatus fmi2SetReal(void* c, const unsigned* reference, std::size_t count, const double* value) {
  return of(c).set(reference, count, value);
}

FMI_FUNCTION FmuStatus fmi2DoStep(void* c, double now, double step, int) { return of(c).step(now, step); }

SHARED_FUNCTIONS(fmi2, FMUstate, DeSerialize, char)

FMI_FUNCTION FmuStatus fmi2GetStatus(void*, int, FmuStatus*) { return FMU_DISCARD; }  // no step is ever pending
FMI_FUNCTION FmuStatus fmi2GetRealStatus(void* c, int kind, double* value) {
  if (kind != LAST_SUCCESSFUL_TIME) return FMU_DISCARD;
  *value = of(c).time();
  return FMU_OK;
}
FMI_FUNCTION FmuStatus fmi2GetIntegerStatus(void*, int, int*) { return FMU_DISCARD; }
FMI_FUNCTION FmuStatus fmi2GetBooleanStatus(void*, int kind, int* value) {
  if (kind != TERMINATED) return FMU_DISCARD;
  *value = 0;
  return FMU_OK;
}
FMI_FUNCTION FmuStatus fmi2GetStringStatus(void*, int, const char**) { return FMU_DISCARD; }
FMI_FUNCTION FmuStatus fmi2CancelStep(void* c) { return of(c).refuse("no step is ever pending"); }

// There are no variables of other kinds; none of them is all that can be asked for.
#define NO_VARIABLES(name, value_type)                                                   \
  FMI_FUNCTION FmuStatus name(void* c, const unsigned*, std::size_t count, value_type) { \
    return count == 0 ? FMU_OK : of(c).refuse("all variables of this model are Real");   \
  }
NO_VARIABLES(fmi2GetInteger, int*)
NO_VARIABLES(fmi2GetBoolean, int*)
NO_VARIABLES(fmi2GetString, const char**)
NO_VARIABLES(fmi2SetInteger, const int*)
NO_VARIABLES(fmi2SetBoolean, const int*)
NO_VARIABLES(fmi2SetString, const char* const*)

// modelDescription.xml says that these are not offered.
#define NOT_OFFERED(name, ...) \
  FMI_FUNCTION FmuStatus name(void* c, __VA_ARGS__) { return of(c).refuse(#name " is not offered"); }
NOT_OFFERED(fmi2GetDirectionalDerivative, const unsigned*, std::size_t, const unsigned*, std::size_t, const double*,
            double*)
NOT_OFFERED(fmi2SetRealInputDerivatives, const unsigned*, std::size_t, const int*, const double*)
NOT_OFFERED(fmi2GetRealOutputDerivatives, const unsigned*, std::size_t, const int*, double*)
