// Numbers of many lines, field by field: a declaration of the fields is the whole layout.
#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace skisnow {

// Memory that begins at a whole cache line.
template <class T>
struct CacheLines {
  using value_type = T;
  CacheLines() = default;
  template <class U>
  CacheLines(const CacheLines<U>&) {}
  T* allocate(std::size_t n) { return static_cast<T*>(::operator new(n * sizeof(T), std::align_val_t(64))); }
  void deallocate(T* memory, std::size_t) { ::operator delete(memory, std::align_val_t(64)); }
  bool operator==(const CacheLines&) const { return true; }
};

using Column = std::vector<double, CacheLines<double>>;

// `FIELDS` columns of equal length, in one piece of memory; a copy is a copy of that piece.
template <class Field, int FIELDS>
class Columns {
 public:
  void resize(int length) {
    length_ = length;
    stride_ = length + PAD;
    data_.assign(std::size_t(FIELDS) * std::size_t(stride_), 0.0);
  }
  int length() const { return length_; }
  double* operator[](Field field) { return data_.data() + std::size_t(field) * std::size_t(stride_); }
  const double* operator[](Field field) const { return data_.data() + std::size_t(field) * std::size_t(stride_); }

 private:
  static constexpr int PAD = 8;  // a cache line: columns of 2ⁿ lines would share the same sets of the cache
  int length_ = 0, stride_ = 0;
  Column data_;
};

}  // namespace skisnow
