// Numbers as bytes that any machine reads again, and back with every border checked.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace skisnow {

using Bytes = std::vector<unsigned char>;

// FNV-1a (Fowler, Noll, Vo), 64 bits: of two pieces that differ in one byte it always differs.
std::uint64_t digest_of(const unsigned char* bytes, std::size_t size);

// Each number takes eight bytes, the lowest first. Writer and reader have functions of the same names, so that one
// template states the order and the borders of both; only the reader checks borders.
class ByteWriter {
 public:
  static constexpr bool READS = false;

  void put(std::uint64_t value);
  template <class Whole>
  void whole(const Whole& value, std::int64_t = 0, std::int64_t = 0) {
    put(std::uint64_t(std::int64_t(value)));
  }
  void number(double value);
  void within(double value, double, double) { number(value); }
  void numbers(const double* values, std::size_t count, double = 0.0);
  template <class Numbers>
  void all(const Numbers& values, double = 0.0) {
    numbers(values.data(), values.size());
  }
  void some(const std::vector<double>& values, std::int64_t, double) { all(values); }

  // The bytes written, between a head with their kind and a digest of everything before it.
  Bytes sealed(std::uint64_t kind) const;

 private:
  Bytes bytes_;
};

// Every function throws std::invalid_argument where the bytes end, or have a number that cannot be.
class ByteReader {
 public:
  static constexpr bool READS = true;

  // A reader of sealed bytes, which must outlive it. Refuses what is damaged, of another kind or of another version.
  static ByteReader opened(std::uint64_t kind, const unsigned char* bytes, std::size_t size);

  std::uint64_t take();
  std::int64_t whole(std::int64_t least, std::int64_t most);
  template <class Whole>
  void whole(Whole& value, std::int64_t least, std::int64_t most) {
    value = Whole(whole(least, most));
  }
  double number();  // finite
  void number(double& value) { value = number(); }
  void within(double& value, double least, double most);
  // Each finite, and not farther than this from 0.
  void numbers(double* values, std::size_t count, double most = std::numeric_limits<double>::max());
  void some(std::vector<double>& values, std::int64_t count, double most);
  template <class Numbers>
  void all(Numbers& values, double most = std::numeric_limits<double>::max()) {
    numbers(values.data(), values.size(), most);
  }
  std::size_t left() const { return std::size_t(end_ - at_); }
  void require_end() const;

 private:
  const unsigned char *at_, *end_;

  ByteReader(const unsigned char* at, const unsigned char* end) : at_(at), end_(end) {}
};

[[noreturn]] void refuse_bytes(const std::string& why);

}  // namespace skisnow
