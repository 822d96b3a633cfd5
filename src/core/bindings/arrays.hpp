// Arrays of NumPy, in and out.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <utility>
#include <vector>

namespace skisnow {

namespace nb = nanobind;

using Array = nb::ndarray<const double, nb::c_contig, nb::device::cpu>;
using Result = nb::ndarray<nb::numpy, double>;

inline std::vector<double> copied(const Array& a) { return {a.data(), a.data() + a.size()}; }

inline Result array(std::vector<double> values, std::initializer_list<std::size_t> shape) {
  auto* kept = new std::vector<double>(std::move(values));
  nb::capsule owner(kept, [](void* p) noexcept { delete static_cast<std::vector<double>*>(p); });
  return Result(kept->data(), shape, owner);
}

inline Result array(std::vector<double> values) {
  const std::size_t size = values.size();
  return array(std::move(values), {size});
}

}  // namespace skisnow
