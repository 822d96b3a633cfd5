// Linear systems of a body and the beams that are clamped to it: a band for each beam, the body's six unknowns as their
// border.
#pragma once

#include <vector>

#include "columns.hpp"

namespace skisnow {

constexpr int BODY = 6;        // unknowns of the body
constexpr int HALF_BAND = 5;   // of a beam with three unknowns to a node
constexpr int BORDER_ROW = 8;  // doubles, the last two zero

// Where the body and the beams have their numbers in one vector. Behind each part come zeros, so that loops over a band
// need no ends.
class Layout {
 public:
  Layout() = default;
  explicit Layout(const std::vector<int>& sizes);

  int beams() const { return int(size_.size()); }
  int size(int beam) const { return size_[std::size_t(beam)]; }
  int first(int beam) const { return first_[std::size_t(beam)]; }
  int length() const { return length_; }

 private:
  std::vector<int> size_, first_;
  int length_ = BORDER_ROW;
};

using Numbers = Column;  // of a layout: 0 to 5 the body, then each beam from `first`

class BorderedSystem {
 public:
  BorderedSystem() = default;
  explicit BorderedSystem(const Layout& layout);

  double corner[BODY][BODY];

  void clear();
  // Of one row of a beam: columns row - 5 to row + 5, and the body's; and its column in the body's rows.
  double* band(int beam, int row) { return band_.data() + BAND_ROW * at(beam, row); }
  double* border(int beam, int row) { return border_.data() + BORDER_ROW * at(beam, row); }
  double* border_column(int beam, int row) { return column_.data() + BORDER_ROW * at(beam, row); }

  // Factor in place as L U, beams first, without exchanging rows there. False if a pivot is zero or not a number.
  bool factor();
  // Replace a right side by the solution.
  void solve(Numbers& vector) const;

 private:
  static constexpr int BAND_ROW = 2 * HALF_BAND + 1;

  Layout layout_;
  Column band_, border_, column_;
  int order_[BODY];

  std::size_t at(int beam, int row) const { return std::size_t(layout_.first(beam) + row); }
  bool eliminate(int beam);
  bool factor_corner();
  void solve_corner(double* right) const;
};

}  // namespace skisnow
