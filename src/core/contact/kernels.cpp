// Sections, pressure and forces over lanes of lines. Compiled once for each instruction set: SKISNOW_LANES names its
// namespace, SKISNOW_WIDTH is the number of lanes.
//
// Equations: docs/methods/contact.md; the names in brackets there are those of the functions in these headers.
#include "contact/force_kernels.hpp"
#include "contact/line_kernels.hpp"
#include "contact/mark_kernels.hpp"
#include "contact/tangent_kernels.hpp"

namespace skisnow::SKISNOW_LANES {

#define SKISNOW_TEXT(x) #x
#define SKISNOW_NAME(x) SKISNOW_TEXT(x)

using Width = Lanes<SKISNOW_WIDTH>;

extern const Kernels SET{.name = SKISNOW_NAME(SKISNOW_LANES),
                         .lanes = SKISNOW_WIDTH,
                         .find_sections = find_sections<Width>,
                         .press = press<Width>,
                         .slide = slide<Width>,
                         .push = push<Width>,
                         .sum_power = sum_power<Width>,
                         .differ = differ<Width>,
                         .add_stiffness = add_stiffness,
                         .find_unknown = find_unknown<Width>,
                         .square_depths = square_depths<Width>,
                         .mark = mark<Width>,
                         .drag_anchors = drag_anchors<Width>,
                         .find_vertices = find_vertices<Width>,
                         .band = {eliminate, substitute_forwards, substitute_backwards, add_band, add_coupling,
                                  add_coupled, combine, add_congruent}};

}  // namespace skisnow::SKISNOW_LANES
