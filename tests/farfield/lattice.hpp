// Potential and field of periodic and mirrored charges, written out: in space by Ewald's sum with many terms, in the plane
// by rows of charges, whose sums are known and fall exponentially with the distance of the row. Mirrored axes are periodic
// ones of twice the length with mirrored sources.
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "farfield/farfield.hpp"

namespace lattice {

using farfield::Points;
using std::numbers::pi;

/// Potential and field of one charge and its copies at z = target - source, without the copy at z = 0.
struct Value {
  double potential = 0, field[3] = {};
};

/// In space, with mean 0 over the box.
inline Value ewald(const double* z, const double* period) {
  const double volume = period[0] * period[1] * period[2], a = 2.2 / std::cbrt(volume);
  Value value{.potential = -pi / (a * a * volume)};
  int most[3], waves[3];
  for (int l = 0; l < 3; ++l) {
    most[l] = static_cast<int>(std::ceil((6.5 / a + std::abs(z[l])) / period[l]));
    waves[l] = static_cast<int>(std::ceil(13 * a * period[l] / (2 * pi)));
  }
  for (int i = -most[0]; i <= most[0]; ++i)
    for (int j = -most[1]; j <= most[1]; ++j)
      for (int k = -most[2]; k <= most[2]; ++k) {
        const double x = z[0] - i * period[0], y = z[1] - j * period[1], w = z[2] - k * period[2];
        const double r = std::sqrt(x * x + y * y + w * w), bell = 2 * a / std::sqrt(pi) * std::exp(-a * a * r * r);
        if (r < 1e-12 * period[0]) {
          value.potential -= 2 * a / std::sqrt(pi);
          continue;
        }
        value.potential += std::erfc(a * r) / r;
        const double strength = (std::erfc(a * r) / r + bell) / (r * r);
        value.field[0] += strength * x, value.field[1] += strength * y, value.field[2] += strength * w;
      }
  for (int i = -waves[0]; i <= waves[0]; ++i)
    for (int j = -waves[1]; j <= waves[1]; ++j)
      for (int k = -waves[2]; k <= waves[2]; ++k) {
        if (i == 0 && j == 0 && k == 0) continue;
        const double wave[3] = {2 * pi * i / period[0], 2 * pi * j / period[1], 2 * pi * k / period[2]};
        const double squared = wave[0] * wave[0] + wave[1] * wave[1] + wave[2] * wave[2],
                     phase = wave[0] * z[0] + wave[1] * z[1] + wave[2] * z[2],
                     strength = 4 * pi / volume * std::exp(-squared / (4 * a * a)) / squared;
        value.potential += strength * std::cos(phase);
        for (int l = 0; l < 3; ++l) value.field[l] += strength * wave[l] * std::sin(phase);
      }
  return value;
}

/// A row of charges along axis 0 of the plane: -ln |2 sin(pi w / P)|, less pi |z_1| / P.
inline Value row(double x, double y, double period) {
  const double small = std::exp(-2 * pi * std::abs(y) / period), cosine = std::cos(2 * pi * x / period),
               sine = std::sin(2 * pi * x / period), half = std::sin(pi * x / period);
  const double squared = (1 - small) * (1 - small) + 4 * small * half * half;
  if (squared < 1e-24) return {.potential = -std::log(2 * pi / period)};
  Value value{.potential = -std::log(squared) / 2};
  value.field[0] = small * sine * 2 * pi / period / squared;
  value.field[1] = (y == 0 ? 0 : y < 0 ? -1 : 1) * small * (cosine - small) * 2 * pi / period / squared;
  return value;
}

/// In the plane, with mean 0 over the box; period[1] = 0: one row of charges, along axis 0.
inline Value rows(const double* z, const double* period) {
  if (period[1] == 0) {
    Value value = row(z[0], z[1], period[0]);
    value.potential -= pi * std::abs(z[1]) / period[0];
    value.field[1] += z[1] == 0 ? 0 : (z[1] < 0 ? -1 : 1) * pi / period[0];
    return value;
  }
  const double y = z[1] - period[1] * std::round(z[1] / period[1]), side = y == 0 ? 0 : (y < 0 ? -1 : 1);
  // The mean along the row: its second derivative is constant between rows.
  Value value{.potential = 2 * pi / period[0] * (y * y / (2 * period[1]) - std::abs(y) / 2 + period[1] / 12)};
  value.field[1] = -2 * pi / period[0] * (y / period[1] - side / 2);
  const int most = static_cast<int>(std::ceil(7 * period[0] / period[1])) + 1;
  for (int n = -most; n <= most; ++n) {
    const Value one = row(z[0], y + n * period[1], period[0]);
    value.potential += one.potential;
    value.field[0] += one.field[0], value.field[1] += one.field[1];
  }
  return value;
}

/// A source and its mirror images within one period.
template <int d>
struct Image {
  double place[3] = {}, charge = 1;
};

template <int d>
std::vector<Image<d>> images(const farfield::Options& options, const double* place, double charge) {
  std::vector<Image<d>> found(1);
  for (int l = 0; l < d; ++l) found[0].place[l] = place[l];
  found[0].charge = charge;
  const double turn = options.mirror_images == farfield::MirrorImages::opposite ? -1 : 1;
  for (int l = 0; l < d; ++l) {
    if (options.axes[l].ends != farfield::Ends::mirrors) continue;
    for (std::size_t i = 0, count = found.size(); i < count; ++i) {
      Image<d> image = found[i];
      image.place[l] = 2 * options.axes[l].low - image.place[l];
      image.charge *= turn;
      found.push_back(image);
    }
  }
  return found;
}

/// What a plan is to return, with what the promise is relative to: the sums over the sources and those of their copies
/// that touch the box.
template <int d>
struct Sums {
  Eigen::VectorXd potential, potential_scale, field_scale;
  Points<d> field;
};

/// Points lie in the box. core_radius: of vortex blobs; 0: charges.
template <int d>
Sums<d> sum(const farfield::Options& options, const Points<d>& sources, const Points<d>& targets,
            const Eigen::VectorXd& charges) {
  const Eigen::Index count = targets.cols();
  const double core = options.core_radius;
  Sums<d> sums{Eigen::VectorXd::Zero(count), Eigen::VectorXd::Zero(count), Eigen::VectorXd::Zero(count),
               Points<d>::Zero(d, count)};
  double period[3] = {};
  for (int l = 0; l < d; ++l)
    if (options.axes[l].ends != farfield::Ends::unbounded)
      period[l] =
          (options.axes[l].high - options.axes[l].low) * (options.axes[l].ends == farfield::Ends::mirrors ? 2 : 1);
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index j = 0; j < sources.cols(); ++j)
      for (const Image<d>& image : images<d>(options, sources.col(j).data(), charges[j])) {
        double z[3] = {};
        for (int l = 0; l < d; ++l) z[l] = targets(l, i) - image.place[l];
        Value value = d == 3 ? ewald(z, period) : rows(z, period);
        // Copies one by one, for the promise, and for cores that change what they do nearby.
        int most[3] = {};
        for (int l = 0; l < d; ++l) most[l] = period[l] > 0 ? 1 : 0;
        for (int a = -most[0]; a <= most[0]; ++a)
          for (int b = -most[1]; b <= most[1]; ++b)
            for (int c = -most[2]; c <= most[2]; ++c) {
              const double x = z[0] - a * period[0], y = z[1] - b * period[1], w = z[2] - c * period[2],
                           squared = x * x + y * y + w * w, r = std::sqrt(squared);
              if (r < 1e-12) continue;
              if (core > 0) {
                const double less = std::exp(-squared / (core * core)) / squared;
                value.field[0] -= less * x, value.field[1] -= less * y;
              }
              const double copy[3] = {a * period[0], b * period[1], c * period[2]};
              bool touches = true;
              for (int l = 0; l < d; ++l) {
                const farfield::Axis& axis = options.axes[l];
                const double place = image.place[l] + copy[l], length = axis.high - axis.low;
                if (period[l] > 0) touches = touches && place >= axis.low - length && place <= axis.high + length;
              }
              if (!touches) continue;
              sums.field_scale[i] += std::abs(image.charge) / (d == 3 ? squared : r);
              sums.potential_scale[i] += std::abs(image.charge) * (d == 3 ? 1 / r : 1 + std::abs(std::log(r)));
            }
        sums.potential[i] += image.charge * value.potential;
        for (int l = 0; l < d; ++l) sums.field(l, i) += image.charge * value.field[l];
      }
  if (core > 0) {  // velocities: turned by a quarter
    const Eigen::RowVectorXd across = sums.field.row(0);
    sums.field.row(0) = -sums.field.row(1) / (2 * pi);
    sums.field.row(1) = across / (2 * pi);
    sums.field_scale /= 2 * pi;
  }
  return sums;
}

}  // namespace lattice
