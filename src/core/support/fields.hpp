// Numbers under names, as text: what a model is made of, for programs that have no Python.
#pragma once

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <map>
#include <string>
#include <vector>

namespace skisnow {

class Fields {
 public:
  void put(const std::string& name, double value) { numbers_[name] = {value}; }
  template <class Numbers>
  void put(const std::string& name, const Numbers& values) {
    numbers_[name].assign(std::begin(values), std::end(values));
  }

  // Each throws std::invalid_argument if the name is missing or has another number of values.
  const std::vector<double>& at(const std::string& name) const;
  const std::vector<double>& at(const std::string& name, std::size_t count) const;
  double number(const std::string& name) const { return at(name, 1)[0]; }
  int whole(const std::string& name) const { return int(number(name)); }
  template <class Numbers>
  void take(const std::string& name, Numbers& values) const {
    const auto& found = at(name, std::size_t(std::end(values) - std::begin(values)));
    std::copy(found.begin(), found.end(), std::begin(values));
  }

  // A line for each name: the name, how many numbers, and these, which are read again to the last bit.
  std::string text() const;
  static Fields read(const std::string& text);
  // Of all names and numbers, the same on every machine.
  std::uint64_t digest() const;

 private:
  std::map<std::string, std::vector<double>> numbers_;
};

}  // namespace skisnow
