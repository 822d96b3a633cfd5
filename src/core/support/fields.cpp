#include "support/fields.hpp"

#include <locale>
#include <sstream>
#include <stdexcept>

#include "support/bytes.hpp"

namespace skisnow {

namespace {

constexpr int EXACT = 17;          // digits after which a double is itself again
constexpr int MOST = 100'000'000;  // numbers of one name

}  // namespace

const std::vector<double>& Fields::at(const std::string& name) const {
  const auto found = numbers_.find(name);
  if (found == numbers_.end()) throw std::invalid_argument("the model's data have no " + name);
  return found->second;
}

const std::vector<double>& Fields::at(const std::string& name, std::size_t count) const {
  const auto& found = at(name);
  if (found.size() != count)
    throw std::invalid_argument("the model's data have " + std::to_string(found.size()) + " numbers for " + name +
                                "; there must be " + std::to_string(count));
  return found;
}

std::uint64_t Fields::digest() const {
  ByteWriter all;
  for (const auto& [name, values] : numbers_) {
    all.put(digest_of(reinterpret_cast<const unsigned char*>(name.data()), name.size()));
    all.whole(std::int64_t(values.size())), all.all(values);
  }
  const Bytes bytes = all.sealed(0);
  return digest_of(bytes.data(), bytes.size());
}

std::string Fields::text() const {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out.precision(EXACT);
  for (const auto& [name, values] : numbers_) {
    out << name << ' ' << values.size();
    for (double each : values) out << ' ' << each;
    out << '\n';
  }
  return out.str();
}

Fields Fields::read(const std::string& text) {
  std::istringstream in(text);
  in.imbue(std::locale::classic());
  Fields out;
  std::string name;
  for (int count; in >> name;) {
    if (!(in >> count) || count < 0 || count > MOST)
      throw std::invalid_argument("the model's data say of " + name + " no sound count");
    auto& values = out.numbers_[name];
    for (double each; int(values.size()) < count;) {
      if (!(in >> each)) throw std::invalid_argument("the model's data end, or have no number, within " + name);
      values.push_back(each);
    }
  }
  return out;
}

}  // namespace skisnow
