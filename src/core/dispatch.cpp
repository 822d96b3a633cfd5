// Which of the compiled instruction sets this processor has.
#include <cstring>

#include "sections.hpp"

namespace skisnow {

namespace baseline {
extern const Kernels SET;
}
#ifdef SKISNOW_X86
namespace avx2 {
extern const Kernels SET;
}
namespace avx512 {
extern const Kernels SET;
}
#endif

const Kernels* kernels_named(const char* name) {
  if (std::strcmp(name, baseline::SET.name) == 0) return &baseline::SET;
#ifdef SKISNOW_X86
  if (std::strcmp(name, avx2::SET.name) == 0 && __builtin_cpu_supports("avx2")) return &avx2::SET;
  if (std::strcmp(name, avx512::SET.name) == 0 && __builtin_cpu_supports("avx512f") &&
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
    return &avx512::SET;
#endif
  return nullptr;
}

const Kernels& kernels() {
  for (const char* name : {"avx512", "avx2"})
    if (const Kernels* found = kernels_named(name)) return *found;
  return baseline::SET;
}

void Sections::prepare(const GrooveLines& lines) {
  if (values.length() != lines.capacity()) values.resize(lines.capacity());
  first_block = lines.first >= 0 ? lines.first / BLOCK : -((-lines.first + BLOCK - 1) / BLOCK);
  blocks = int((lines.end - first_block * BLOCK + BLOCK - 1) / BLOCK);
}

}  // namespace skisnow
