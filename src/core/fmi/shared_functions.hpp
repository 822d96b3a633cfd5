// The functions that FMI 2.0 and 3.0 share but for their names.
#pragma once

#include "fmi/fmu_instance.hpp"

inline skisnow::FmuInstance& of(void* instance) { return *static_cast<skisnow::FmuInstance*>(instance); }

#define SHARED_FUNCTIONS(fmi, State, DeSerialize, Byte) /* NOLINT(bugprone-macro-parentheses) */               \
  FMI_FUNCTION void fmi##FreeInstance(void* c) { delete static_cast<FmuInstance*>(c); }                        \
  FMI_FUNCTION FmuStatus fmi##ExitInitializationMode(void* c) { return of(c).exit_initialization(); }          \
  FMI_FUNCTION FmuStatus fmi##Terminate(void* c) { return of(c).terminate(); }                                 \
  FMI_FUNCTION FmuStatus fmi##Reset(void* c) { return of(c).reset(); }                                         \
  FMI_FUNCTION FmuStatus fmi##Get##State(void* c, void** state) { return of(c).keep(state); }                  \
  FMI_FUNCTION FmuStatus fmi##Set##State(void* c, void* state) { return of(c).take(state); }                   \
  FMI_FUNCTION FmuStatus fmi##Free##State(void*, void** state) { return FmuInstance::free_state(state); }      \
  FMI_FUNCTION FmuStatus fmi##Serialized##State##Size(void* c, void* state, std::size_t* size) {               \
    return of(c).size(state, size);                                                                            \
  }                                                                                                            \
  FMI_FUNCTION FmuStatus fmi##Serialize##State(void* c, void* state, Byte* bytes, std::size_t size) {          \
    return of(c).write(state, bytes, size);                                                                    \
  }                                                                                                            \
  FMI_FUNCTION FmuStatus fmi##DeSerialize##State(void* c, const Byte* bytes, std::size_t size, void** state) { \
    return of(c).read(bytes, size, state);                                                                     \
  }
