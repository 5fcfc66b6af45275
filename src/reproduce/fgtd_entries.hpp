// What the tables of the fast transform enter: numbers of a measurement, and names of rows.
#pragma once

#include <cmath>
#include <cstddef>

#include "reproduce/fgtd.hpp"
#include "reproduce/measured_sum.hpp"
#include "reproduce/published.hpp"

namespace gaussdrift::reproduce {

constexpr int all_boxes = fgtd::HermiteParameters::all_boxes;

inline double boxes_of(int d, int nu) { return std::pow(nu, d); }

inline Entry absolute_errors(const Measurement& hermite, const Measurement& automatic) {
  return {hermite.absolute, automatic.absolute, automatic.absolute <= automatic.allowed};
}
inline Entry relative_errors(const Measurement& hermite, const Measurement& automatic) {
  return {hermite.relative, automatic.relative, automatic.absolute <= automatic.allowed};
}

// The number that a row is named by: nu, N, sigma, c.
inline double row_number(const PublishedTable& published, std::size_t row) {
  return *published.number(row, published.columns()[0]);
}

inline double seconds_for(const Measurement& measured, double targets) {
  return measured.prepare + targets * measured.evaluate;
}

}  // namespace gaussdrift::reproduce
