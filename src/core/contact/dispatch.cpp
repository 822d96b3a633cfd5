// Which of the compiled instruction sets this processor has.
#include <cstring>

#include "contact/sections.hpp"

#ifdef SKISNOW_X86
#include <cpuid.h>
#endif

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

namespace {

// Asked here: __builtin_cpu_supports finds nothing where Zig's compiler builds.
struct Processor {
  bool avx2 = false, avx512 = false;

  Processor() {
    unsigned a, b, c, d;
    if (!__get_cpuid(1, &a, &b, &c, &d) || !(c & bit_OSXSAVE)) return;
    unsigned kept, high;  // registers that the operating system keeps
    __asm__("xgetbv" : "=a"(kept), "=d"(high) : "c"(0));
    if (!__get_cpuid_count(7, 0, &a, &b, &c, &d)) return;
    constexpr unsigned YMM = 0x06, ZMM = 0xe6, FOUNDATION = bit_AVX512F | bit_AVX512DQ | bit_AVX512VL;
    avx2 = (kept & YMM) == YMM && (b & bit_AVX2);
    avx512 = (kept & ZMM) == ZMM && (b & FOUNDATION) == FOUNDATION;
  }
};

const Processor& processor() {
  static const Processor found;
  return found;
}

}  // namespace
#endif

const Kernels* kernels_named(const char* name) {
  if (std::strcmp(name, baseline::SET.name) == 0) return &baseline::SET;
#ifdef SKISNOW_X86
  if (std::strcmp(name, avx2::SET.name) == 0 && processor().avx2) return &avx2::SET;
  if (std::strcmp(name, avx512::SET.name) == 0 && processor().avx512) return &avx512::SET;
#endif
  return nullptr;
}

const Kernels& kernels() {
  for (const char* name : {"avx512", "avx2"})
    if (const Kernels* found = kernels_named(name)) return *found;
  return baseline::SET;
}

Sections::Sections(int capacity) {
  base.resize(capacity), pressure.resize(capacity), edge.resize(capacity);
  sliding.resize(capacity), forces.resize(capacity);
}

void Base::cover(const GrooveLines& lines, const double* of) {
  first_block = lines.first >= 0 ? lines.first / BLOCK : -((-lines.first + BLOCK - 1) / BLOCK);
  blocks = lines.count() > 0 ? int((lines.end - first_block * BLOCK + BLOCK - 1) / BLOCK) : 0;
  wanted.assign(std::size_t(blocks), of == nullptr ? SECTIONS : NOTHING);
  for (int i = 0; of != nullptr && i < count(); i++) {
    if (of[lines.slot(line(i))] == 0.0) continue;
    wanted[std::size_t(i / BLOCK)] = SECTIONS;
    for (const int next : {i - 1, i + 1})  // the share of a line ends halfway to its neighbours
      if (next >= 0 && next < count() && wanted[std::size_t(next / BLOCK)] == NOTHING)
        wanted[std::size_t(next / BLOCK)] = STATIONS;
  }
}

}  // namespace skisnow
