#include "support/bytes.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace skisnow {

namespace {

constexpr unsigned char MAGIC[8] = {'s', 'k', 'i', 's', 'n', 'o', 'w', '\n'};
constexpr std::uint64_t VERSION = 6;                           // of all that is written
constexpr std::size_t WORD = 8, HEAD = 4 * WORD, FOOT = WORD;  // magic, version, kind, length; digest

std::uint64_t word_at(const unsigned char* at) {
  std::uint64_t out = 0;
  for (std::size_t i = 0; i < WORD; i++) out |= std::uint64_t(at[i]) << (8 * i);
  return out;
}

void append_word(Bytes& out, std::uint64_t value) {
  for (std::size_t i = 0; i < WORD; i++) out.push_back(static_cast<unsigned char>(value >> (8 * i) & 0xFF));
}

}  // namespace

std::uint64_t digest_of(const unsigned char* bytes, std::size_t size) {
  std::uint64_t out = 14695981039346656037ULL;
  for (std::size_t i = 0; i < size; i++) out = (out ^ bytes[i]) * 1099511628211ULL;
  return out;
}

void refuse_bytes(const std::string& why) { throw std::invalid_argument("the bytes are no state: " + why); }

void ByteWriter::put(std::uint64_t value) { append_word(bytes_, value); }

void ByteWriter::number(double value) { put(std::bit_cast<std::uint64_t>(value)); }

void ByteWriter::numbers(const double* values, std::size_t count, double) {
  for (std::size_t i = 0; i < count; i++) number(values[i]);
}

Bytes ByteWriter::sealed(std::uint64_t kind) const {
  Bytes out(std::begin(MAGIC), std::end(MAGIC));
  out.reserve(HEAD + bytes_.size() + FOOT);
  append_word(out, VERSION), append_word(out, kind), append_word(out, bytes_.size());
  out.insert(out.end(), bytes_.begin(), bytes_.end());
  append_word(out, digest_of(out.data(), out.size()));
  return out;
}

ByteReader ByteReader::opened(std::uint64_t kind, const unsigned char* bytes, std::size_t size) {
  if (bytes == nullptr) refuse_bytes("they are NULL");
  if (size < WORD || !std::equal(std::begin(MAGIC), std::end(MAGIC), bytes)) refuse_bytes("they begin as none does");
  if (size < HEAD + FOOT) refuse_bytes("they end too early");
  if (word_at(bytes + size - FOOT) != digest_of(bytes, size - FOOT)) refuse_bytes("they are damaged or not complete");
  if (word_at(bytes + WORD) != VERSION)
    refuse_bytes("they are of version " + std::to_string(word_at(bytes + WORD)) + "; this library reads version " +
                 std::to_string(VERSION));
  if (word_at(bytes + 2 * WORD) != kind) refuse_bytes("they are that of another kind of model");
  if (word_at(bytes + 3 * WORD) != size - HEAD - FOOT) refuse_bytes("their length is not the one that they name");
  return {bytes + HEAD, bytes + size - FOOT};
}

std::uint64_t ByteReader::take() {
  if (left() < WORD) refuse_bytes("they end within a number");
  const std::uint64_t out = word_at(at_);
  at_ += WORD;
  return out;
}

std::int64_t ByteReader::whole(std::int64_t least, std::int64_t most) {
  const auto out = std::int64_t(take());
  if (out < least || out > most)
    refuse_bytes("a whole number in them is " + std::to_string(out) + "; it must be from " + std::to_string(least) +
                 " to " + std::to_string(most));
  return out;
}

double ByteReader::number() {
  const auto out = std::bit_cast<double>(take());
  if (!std::isfinite(out)) refuse_bytes("a number in them is not finite");
  return out;
}

void ByteReader::within(double& value, double least, double most) {
  value = number();
  if (!(value >= least && value <= most))
    refuse_bytes("a number in them is " + std::to_string(value) + "; it must be from " + std::to_string(least) +
                 " to " + std::to_string(most));
}

void ByteReader::numbers(double* values, std::size_t count, double most) {
  for (std::size_t i = 0; i < count; i++) within(values[i], -most, most);
}

void ByteReader::some(std::vector<double>& values, std::int64_t count, double most) {
  if (std::size_t(count) > left() / WORD) refuse_bytes("they name more numbers than they have");
  values.resize(std::size_t(count));
  all(values, most);
}

void ByteReader::require_end() const {
  if (at_ != end_) refuse_bytes("they have more than a state has");
}

}  // namespace skisnow
