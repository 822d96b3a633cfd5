// The functions of FMI 2.0 for co-simulation (fmi-standard.org), declared here as far as they are used.
#include <cstring>
#include <exception>
#include <string>

#include "fmi/fmu_instance.hpp"

#if defined(_WIN32)
#define FMI2_FUNCTION extern "C" __declspec(dllexport)
#else
#define FMI2_FUNCTION extern "C" __attribute__((visibility("default")))
#endif

using skisnow::FmuInstance;
using skisnow::FmuStatus;

namespace {

using Status = int;
using Logger = void (*)(void* environment, const char* name, Status, const char* category, const char* message, ...);
struct Callbacks {
  Logger logger;
  void* (*allocate)(std::size_t, std::size_t);
  void (*release)(void*);
  void (*step_finished)(void*, Status);
  void* environment;
};

constexpr int CO_SIMULATION = 1;
constexpr int LAST_SUCCESSFUL_TIME = 2, TERMINATED = 3;
constexpr Status OK = 0, DISCARD = 2;

Status said(FmuStatus status) { return Status(status); }

FmuInstance& of(void* component) { return *static_cast<FmuInstance*>(component); }

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
    logger(environment, own.c_str(), said(status), "logStatusError", as_format(words).c_str());
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
    if (high < 0 || low < 0) {
      out += rest[i];
      continue;
    }
    out += char(16 * high + low);
    i += 2;
  }
  return out;
}

}  // namespace

FMI2_FUNCTION const char* fmi2GetTypesPlatform() { return "default"; }
FMI2_FUNCTION const char* fmi2GetVersion() { return "2.0"; }
FMI2_FUNCTION Status fmi2SetDebugLogging(void*, int, std::size_t, const char* const*) { return OK; }

FMI2_FUNCTION void* fmi2Instantiate(const char* name, int kind, const char* token, const char* resources,
                                    const Callbacks* callbacks, int, int) {
  const FmuInstance::Log log = log_of(callbacks, name == nullptr ? "" : name);
  try {
    if (kind != CO_SIMULATION) throw std::invalid_argument("this FMU is for co-simulation only");
    if (token == nullptr || resources == nullptr) throw std::invalid_argument("token or place of resources is NULL");
    return new FmuInstance(path_of(resources), token, log);
  } catch (const std::exception& wrong) {
    if (log) log(FmuStatus::ERROR, wrong.what());
    return nullptr;
  }
}

FMI2_FUNCTION void fmi2FreeInstance(void* c) { delete static_cast<FmuInstance*>(c); }

FMI2_FUNCTION Status fmi2SetupExperiment(void* c, int, double, double start, int, double) {
  return said(of(c).set_up(start));
}
FMI2_FUNCTION Status fmi2EnterInitializationMode(void* c) { return said(of(c).enter_initialization()); }
FMI2_FUNCTION Status fmi2ExitInitializationMode(void* c) { return said(of(c).exit_initialization()); }
FMI2_FUNCTION Status fmi2Terminate(void* c) { return said(of(c).terminate()); }
FMI2_FUNCTION Status fmi2Reset(void* c) { return said(of(c).reset()); }

FMI2_FUNCTION Status fmi2GetReal(void* c, const unsigned* reference, std::size_t count, double* value) {
  return said(of(c).get(reference, count, value));
}
FMI2_FUNCTION Status fmi2SetReal(void* c, const unsigned* reference, std::size_t count, const double* value) {
  return said(of(c).set(reference, count, value));
}

FMI2_FUNCTION Status fmi2DoStep(void* c, double now, double step, int) { return said(of(c).step(now, step)); }

FMI2_FUNCTION Status fmi2GetFMUstate(void* c, void** state) {
  return said(of(c).keep(reinterpret_cast<FmuInstance::State**>(state)));
}
FMI2_FUNCTION Status fmi2SetFMUstate(void* c, void* state) {
  return said(of(c).take(static_cast<const FmuInstance::State*>(state)));
}
FMI2_FUNCTION Status fmi2FreeFMUstate(void*, void** state) {
  delete static_cast<FmuInstance::State*>(*state);
  *state = nullptr;
  return OK;
}

FMI2_FUNCTION Status fmi2SerializedFMUstateSize(void* c, void* state, std::size_t* size) {
  return said(of(c).size(static_cast<const FmuInstance::State*>(state), size));
}
FMI2_FUNCTION Status fmi2SerializeFMUstate(void* c, void* state, char* bytes, std::size_t size) {
  return said(
      of(c).write(static_cast<const FmuInstance::State*>(state), reinterpret_cast<unsigned char*>(bytes), size));
}
FMI2_FUNCTION Status fmi2DeSerializeFMUstate(void* c, const char* bytes, std::size_t size, void** state) {
  return said(
      of(c).read(reinterpret_cast<const unsigned char*>(bytes), size, reinterpret_cast<FmuInstance::State**>(state)));
}

FMI2_FUNCTION Status fmi2GetStatus(void*, int, Status*) { return DISCARD; }  // no step is ever pending
FMI2_FUNCTION Status fmi2GetRealStatus(void* c, int kind, double* value) {
  if (kind != LAST_SUCCESSFUL_TIME) return DISCARD;
  *value = of(c).time();
  return OK;
}
FMI2_FUNCTION Status fmi2GetIntegerStatus(void*, int, int*) { return DISCARD; }
FMI2_FUNCTION Status fmi2GetBooleanStatus(void*, int kind, int* value) {
  if (kind != TERMINATED) return DISCARD;
  *value = 0;
  return OK;
}
FMI2_FUNCTION Status fmi2GetStringStatus(void*, int, const char**) { return DISCARD; }
FMI2_FUNCTION Status fmi2CancelStep(void* c) { return said(of(c).refuse("no step is ever pending")); }

// There are no variables of other kinds; none of them is all that can be asked for.
#define NO_VARIABLES(name, value_type)                                                   \
  FMI2_FUNCTION Status name(void* c, const unsigned*, std::size_t count, value_type) {   \
    return count == 0 ? OK : said(of(c).refuse("all variables of this model are Real")); \
  }
NO_VARIABLES(fmi2GetInteger, int*)
NO_VARIABLES(fmi2GetBoolean, int*)
NO_VARIABLES(fmi2GetString, const char**)
NO_VARIABLES(fmi2SetInteger, const int*)
NO_VARIABLES(fmi2SetBoolean, const int*)
NO_VARIABLES(fmi2SetString, const char* const*)

// modelDescription.xml says that these are not offered.
#define NOT_OFFERED(name, ...) \
  FMI2_FUNCTION Status name(void* c, __VA_ARGS__) { return said(of(c).refuse(#name " is not offered")); }
NOT_OFFERED(fmi2GetDirectionalDerivative, const unsigned*, std::size_t, const unsigned*, std::size_t, const double*,
            double*)
NOT_OFFERED(fmi2SetRealInputDerivatives, const unsigned*, std::size_t, const int*, const double*)
NOT_OFFERED(fmi2GetRealOutputDerivatives, const unsigned*, std::size_t, const int*, double*)
