// Linear systems of a body and the beams that are clamped to it: a band for each beam, bordered by the six freedoms of
// its clamp, which follow from the body's six.
#pragma once

#include <vector>

#include "support/columns.hpp"

namespace skisnow {

constexpr int BODY = 6;        // unknowns of the body
constexpr int HALF_BAND = 5;   // half bandwidth of a beam with three unknowns to a node
constexpr int BORDER_ROW = 8;  // doubles, the last two zero
constexpr int BAND_ROW = 16;   // doubles: 2 × 5 + 1, and zeros, so that eight of a row go at once

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

using Numbers = Column;  // ordered by a layout: 0 to 5 the body, then each beam from `first`

// The rows of one beam.
struct BeamRows {
  int size;
  double *band, *border, *column;
};

// Columns over the unknowns of a beam: the lower diagonals of a symmetric band, [i] is A[i, i - m], or what couples
// each unknown with the body. Zeros follow them.
class BeamColumns {
 public:
  BeamColumns() = default;
  explicit BeamColumns(const std::vector<double>& rows);  // (n, 6)
  const double* operator[](int which) const { return numbers_.data() + std::size_t(which * stride_); }
  int size() const { return size_; }

 private:
  int size_ = 0, stride_ = 0;
  Column numbers_;
};

// Their loops, one set for each instruction set. `corner` has six rows of eight; False where a pivot is zero or no
// number.
struct BandKernels {
  bool (*eliminate)(const BeamRows&, double* corner);
  void (*substitute_forwards)(const BeamRows&, double* x, double* right);
  void (*substitute_backwards)(const BeamRows&, const double* body, double* x);
  // out += scale A (x + share y) for a band; out += scale (columns × body); sums += what the columns give with x
  void (*add_band)(const BeamColumns&, const double* x, const double* y, double share, double scale, double* out);
  void (*add_coupling)(const BeamColumns&, const double* body, double scale, double* out);
  void (*add_coupled)(const BeamColumns&, const double* x, double* sums);
  // out = share_a a + share_b b + c, `count` numbers, a multiple of eight
  void (*combine)(const double* a, double share_a, const double* b, double share_b, const double* c, int count,
                  double* out);
  // out += byᵀ own by, matrices of six rows of eight
  void (*add_congruent)(const double* own, const double* by, double* out);
};

class BorderedSystem {
 public:
  BorderedSystem() = default;
  BorderedSystem(const Layout& layout, const BandKernels& kernels);

  double corner[BODY][BORDER_ROW];
  bool held[BODY] = {};  // unknowns of the body that stay as they are

  // The clamp of a beam: the matrix of its six freedoms in the ski's axes, and those freedoms by the body's.
  struct Clamp {
    double own[BODY][BORDER_ROW] = {}, by_body[BODY][BORDER_ROW] = {};
  };
  Clamp& clamp(int beam) { return clamps_[std::size_t(beam)]; }

  void clear();
  // Of one row of a beam: columns row - 5 to row + 5 and zeros, and the clamp's; and its column in the clamp's rows.
  double* band(int beam, int row) { return band_.data() + BAND_ROW * at(beam, row); }
  double* border(int beam, int row) { return border_.data() + BORDER_ROW * at(beam, row); }
  double* border_column(int beam, int row) { return column_.data() + BORDER_ROW * at(beam, row); }

  // Factor in place as L U, beams first, without exchanging rows there. False if a pivot is zero or not a number.
  bool factor();
  // Replace a right side by the solution.
  void solve(Numbers& vector) const;

 private:
  Layout layout_;
  const BandKernels* kernels_ = nullptr;
  Column band_, border_, column_;
  std::vector<Clamp> clamps_;
  int order_[BODY] = {};

  std::size_t at(int beam, int row) const { return std::size_t(layout_.first(beam) + row); }
  BeamRows rows(int beam) const;
};

}  // namespace skisnow
