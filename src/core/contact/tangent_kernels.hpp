// Sums of the sections' derivatives over a runner, eight numbers of a row at once.
#pragma once

#include "contact/tangent.hpp"
#include "linear_algebra/band_kernels.hpp"

namespace skisnow::SKISNOW_LANES {

inline void add_to(double* row, const Eight& more) { store(row, load<Eight>(row) + more); }

// Eight sections, a row of eight numbers for each.
struct EightSections {
  // [local_movement] How the clamp's six freedoms move the base there to the left and off the snow. The edge runs
  // outwards and up: a way ahead meets the line with another place of it.
  Eight left[BLOCK], off[BLOCK];
  // How the six unknowns of the section's element move the beam there, and what loads there do to them.
  Eight deflection[BLOCK], twist[BLOCK];
  // [friction damping] A force of 1 along the edge, and one aside, on the clamp, and on the beam there; growth of
  // friction with the sliding speeds: along by along, each by the other, aside by aside.
  Eight along[BLOCK], aside[BLOCK], lifted[2], twisted[2], rate[3];

  EightSections(const Sections& s, int i, double by_way, double by_speed) {
    const auto column = [&](auto field) { return load<Eight>(s[field] + i); };
    const Eight none{}, one = none + 1.0, station = column(STATION), to_left = column(GRIP_LEFT), up = column(GRIP_UP);
    const Eight reach = column(GRIP_REACH), sp = column(TWIST_SINE), cp = column(TWIST_COSINE);
    const Eight twisting = reach * column(TWIST_SLOPE), outwards = column(FLARE) * reach / column(HALF_WIDTH);
    const Eight out = outwards * cp - twisting * sp, rise = column(BASE_RISE) - outwards * sp - twisting * cp;
    const Eight z = column(IN_ELEMENT), h = column(ELEMENT_LENGTH), y = 1.0 - z;
    fill(left, {-out, one, none, -column(BASE_HEIGHT), -out * up, station + out * to_left});
    fill(off, {-rise, none, one, none, -station - rise * up, rise * to_left});
    fill(deflection, {y * y * (1.0 + 2.0 * z), h * z * y * y, none, z * z * (3.0 - 2.0 * z), -h * z * z * y, none});
    fill(twist, {none, none, y, none, none, z});
    const Eight force = column(FORCE), fall = column(DEPTH_FALL);
    const auto presses = force > 0.0;
    const Eight to_centre = select(presses, column(MOMENT) / select(presses, force, one), none);
    const Eight at[3] = {station + to_centre * (column(LINE_LEFT_0) - fall * column(LINE_NORMAL_0)),
                         to_left + to_centre * (column(LINE_LEFT_1) - fall * column(LINE_NORMAL_1)),
                         up + to_centre * (column(LINE_LEFT_2) - fall * column(LINE_NORMAL_2))};
    const auto pushed = [&](Eight(&rows)[BLOCK], int way, const Eight& t0, const Eight& t1, const Eight& t2) {
      fill(rows, {t0, t1, t2, at[1] * t2 - at[2] * t1, at[2] * t0 - at[0] * t2, at[0] * t1 - at[1] * t0});
      lifted[way] = t2, twisted[way] = -(reach + to_centre * column(BASE_WIDENING)) * (sp * t1 + cp * t2);
    };
    pushed(along, 0, column(ALONG_0), column(ALONG_1), column(ALONG_2));
    pushed(aside, 1, column(ASIDE_0), column(ASIDE_1), column(ASIDE_2));
    const Eight load = select(presses, column(FRICTION_LOAD), none), mu = load * column(MU);
    const Eight weight = mu * select(column(RUB_BY_WAY) > 0.5, none + by_way, none + by_speed);
    const Eight grows = by_speed * load * column(MU_GROWTH), u = column(RUB), w = column(RUB_ASIDE);
    rate[0] = weight * column(RUB_SLOPE) + grows * u * u, rate[1] = weight * column(RUB_SKEW) + grows * u * w;
    rate[2] = weight * column(RUB_ASIDE_SLOPE) + grows * w * w;
  }

 private:
  static void fill(Eight (&rows)[BLOCK], const Eight (&columns)[BODY]) {
    for (int c = 0; c < BODY; c++) rows[c] = columns[c];
    rows[6] = rows[7] = Eight{};
    transpose(rows);
  }
};

// Minus the derivatives of the answers of eight sections, weighted: [change][answer], and a row of the six on the clamp
// for each section.
struct EightDifferences {
  Eight by[SectionDifferences::CHANGES][SectionDifferences::ANSWERS];
  Eight clamp_by_off[BLOCK], clamp_by_twist[BLOCK];

  EightDifferences(const SectionDifferences& minus, int i, double weight) {
    for (int change = 0; change < SectionDifferences::CHANGES; change++)
      for (int k = 0; k < SectionDifferences::ANSWERS; k++)
        by[change][k] = weight * load<Eight>(minus.column(change, k) + i);
    for (int k = 0; k < BLOCK; k++) {
      clamp_by_off[k] = k < BODY ? by[SectionDifferences::OFF][k] : Eight{};
      clamp_by_twist[k] = k < BODY ? by[SectionDifferences::TWIST][k] : Eight{};
    }
    transpose(clamp_by_off), transpose(clamp_by_twist);
  }
};

// [stiffness] Of one section: answers to its three local movements, and its friction, summed to clamp and beam.
inline void add_section(const EightDifferences& minus, const EightSections& at, int lane, int first, bool bends,
                        Eight (&clamp)[BODY], RunnerTangent& out) {
  constexpr int LEFT = SectionDifferences::LEFT, OFF = SectionDifferences::OFF, TWIST = SectionDifferences::TWIST;
  const Eight rolls{0.0, 0.0, 0.0, -1.0, 0.0, 0.0};  // a rotation of the clamp about the ski's axis is minus a twist
  const Eight &along = at.along[lane], &aside = at.aside[lane];
  const double ahead = at.rate[0][lane], skew = at.rate[1][lane], across = at.rate[2][lane];
  const Eight rubs = ahead * along + skew * aside, rubs_aside = skew * along + across * aside;
  const auto by_clamp = [&](int k) {
    return minus.by[LEFT][k][lane] * at.left[lane] + minus.by[OFF][k][lane] * at.off[lane] +
           minus.by[TWIST][k][lane] * rolls;
  };
  for (int r = 0; r < BODY; r++) clamp[r] += by_clamp(r) + along[r] * rubs + aside[r] * rubs_aside;
  if (!bends) return;
  const double lifted = at.lifted[0][lane], twisted = at.twisted[0][lane];
  const double lifted_aside = at.lifted[1][lane], twisted_aside = at.twisted[1][lane];
  const Eight &deflection = at.deflection[lane], &twist = at.twist[lane];
  const Eight slides = lifted * deflection + twisted * twist,
              slides_aside = lifted_aside * deflection + twisted_aside * twist;
  const Eight rub = ahead * slides + skew * slides_aside, rub_aside = skew * slides + across * slides_aside;
  const Eight lifts = lifted * rubs + lifted_aside * rubs_aside,
              twists_it = twisted * rubs + twisted_aside * rubs_aside;
  const Eight force_by_clamp = by_clamp(6) + lifts, moment_by_clamp = by_clamp(7) + twists_it;
  const Eight clamp_by_lift = minus.clamp_by_off[lane] + lifts;
  const Eight clamp_by_twist = minus.clamp_by_twist[lane] + twists_it;
  const Eight force =
      minus.by[OFF][6][lane] * deflection + minus.by[TWIST][6][lane] * twist + lifted * rub + lifted_aside * rub_aside;
  const Eight moment = minus.by[OFF][7][lane] * deflection + minus.by[TWIST][7][lane] * twist + twisted * rub +
                       twisted_aside * rub_aside;
  double* by_beam = out.body_by_beam.data() + BORDER_ROW * first;
  double* of_beam = out.beam_by_body.data() + BORDER_ROW * first;
  double* band = out.beam.data() + BAND_ROW * first + HALF_BAND;
  for (int q = 0; q < 6; q++) {
    const bool twists = q % 3 == 2;
    const double share = twists ? twist[q] : deflection[q];
    add_to(of_beam + BORDER_ROW * q, share * (twists ? moment_by_clamp : force_by_clamp));
    add_to(by_beam + BORDER_ROW * q, share * (twists ? clamp_by_twist : clamp_by_lift));
    add_to(band + (BAND_ROW - 1) * q, share * (twists ? moment : force));
  }
}

// Weighted, of all sections that touch: their derivatives by pose, and friction by its growth with way and velocity.
inline void add_stiffness(const Sections& s, const SectionDifferences& minus, double stiffness, double by_way,
                          double by_speed, bool bends, RunnerTangent& out) {
  Eight clamp[BODY] = {};
  for (int i = 0; i < s.count(); i += BLOCK) {
    if (!any((load<Eight>(s[SHARE] + i) > 0.0) & (load<Eight>(s[DEEPEST] + i) > 0.0))) continue;
    const EightSections at(s, i, by_way, by_speed);
    const EightDifferences weighted(minus, i, stiffness);
    for (int lane = 0; lane < BLOCK; lane++)
      if (s.touches(i + lane)) add_section(weighted, at, lane, 3 * int(s[ELEMENT][i + lane]), bends, clamp, out);
  }
  for (int r = 0; r < BODY; r++) add_to(out.body[r], clamp[r]);
}

}  // namespace skisnow::SKISNOW_LANES
