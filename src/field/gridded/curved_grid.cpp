#include "field/gridded/curved_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace gaussdrift {

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

double determinant(int dimension, const CurvedGrid::Matrix& a) {
  if (dimension == 2) return a[0][0] * a[1][1] - a[0][1] * a[1][0];
  return a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) - a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0]) +
         a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]);
}

CurvedGrid::Matrix inverse(int dimension, const CurvedGrid::Matrix& a) {
  const double factor = 1 / determinant(dimension, a);
  CurvedGrid::Matrix result{};
  if (dimension == 2) {
    result[0] = {factor * a[1][1], -factor * a[0][1], 0};
    result[1] = {-factor * a[1][0], factor * a[0][0], 0};
    return result;
  }
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t p = (j + 1) % 3, q = (j + 2) % 3, r = (i + 1) % 3, s = (i + 2) % 3;
      result[i][j] = factor * (a[p][r] * a[q][s] - a[p][s] * a[q][r]);
    }
  return result;
}

double length_of(int dimension, const Vector& x) { return std::hypot(x[0], x[1], dimension == 3 ? x[2] : 0.); }

}  // namespace

/// The corners of a cell, the first index fastest, and the box around them.
struct CurvedGrid::Cell {
  int dimension = 2;
  std::array<Vector, 8> corner{};
  Vector least{}, most{};

  int corners() const { return 1 << dimension; }

  /// The place of s in [0, 1]^d.
  Vector at(const Vector& s) const {
    Vector x{};
    for (int c = 0; c < corners(); ++c) {
      double weight = 1;
      for (int k = 0; k < dimension; ++k) weight *= (c >> k & 1) != 0 ? s[k] : 1 - s[k];
      for (int l = 0; l < dimension; ++l) x[l] += weight * corner[c][l];
    }
    return x;
  }

  /// [l][m] = d x_l / d s_m.
  Matrix slopes(const Vector& s) const {
    Matrix result{};
    for (int c = 0; c < corners(); ++c)
      for (int m = 0; m < dimension; ++m) {
        double weight = (c >> m & 1) != 0 ? 1 : -1;
        for (int k = 0; k < dimension; ++k)
          if (k != m) weight *= (c >> k & 1) != 0 ? s[k] : 1 - s[k];
        for (int l = 0; l < dimension; ++l) result[l][m] += weight * corner[c][l];
      }
    return result;
  }

  double size() const {
    double largest = 0;
    for (int k = 0; k < dimension; ++k) largest = std::max(largest, most[k] - least[k]);
    return largest;
  }

  /// Is the volume element positive, with this sign, and not far smaller than the cell?
  bool is_sound(double sign) const {
    constexpr double flat = 1e-10;
    const int steps = dimension == 2 ? 2 : 3;  // in 2D it is linear in each coordinate: corners are enough
    for (int n = 0; n < (dimension == 2 ? 4 : 27); ++n) {
      Vector s{};
      for (int k = 0, rest = n; k < dimension; ++k, rest /= steps) s[k] = double(rest % steps) / (steps - 1);
      const Matrix j = slopes(s);
      double sides = 1;
      for (int m = 0; m < dimension; ++m) {
        Vector column{};
        for (int l = 0; l < dimension; ++l) column[l] = j[l][m];
        sides *= length_of(dimension, column);
      }
      if (!(sign * determinant(dimension, j) > flat * sides)) return false;
    }
    return true;
  }

  /// Newton steps from the middle, halved until the distance falls. Of a place in a convex cell they stay in it, for the
  /// image of their path is nearly a straight line.
  std::optional<Vector> solve(const Vector& x) const {
    constexpr int most_steps = 60;
    constexpr double shortest_part = 1e-3;
    Vector s{0.5, 0.5, dimension == 3 ? 0.5 : 0};
    double scale = size();
    for (int k = 0; k < dimension; ++k) scale = std::max({scale, std::abs(least[k]), std::abs(most[k])});
    const auto away = [&](const Vector& at_s) {
      const Vector at_x = at(at_s);
      Vector d{};
      for (int k = 0; k < dimension; ++k) d[k] = x[k] - at_x[k];
      return d;
    };
    Vector rest = away(s);
    double distance = length_of(dimension, rest);
    for (int step = 0; step < most_steps && distance > 0; ++step) {
      const Matrix back = inverse(dimension, slopes(s));
      Vector way{};
      for (int m = 0; m < dimension; ++m)
        for (int l = 0; l < dimension; ++l) way[m] += back[m][l] * rest[l];
      double part = 1;
      bool nearer = false;
      for (; part > shortest_part && !nearer; part /= 2) {
        Vector next = s;
        for (int m = 0; m < dimension; ++m) next[m] += part * way[m];
        const Vector next_rest = away(next);
        const double next_distance = length_of(dimension, next_rest);
        nearer = next_distance < distance;
        if (nearer) s = next, rest = next_rest, distance = next_distance;
      }
      if (!nearer) break;
    }
    if (!(distance <= 16 * epsilon * scale)) return std::nullopt;
    return s;
  }
};

CurvedGrid::CurvedGrid(int dimension, std::array<std::size_t, max_dimension> points, std::vector<double> places,
                       double rounding)
    : dimension_(dimension), points_(points), places_(std::move(places)), rounding_(rounding) {
  std::size_t all = 1;
  for (int k = 0; k < dimension_; ++k) {
    if (points_[k] < 2) throw std::invalid_argument("a curvilinear grid with fewer than 2 points on an axis");
    all *= points_[k];
    count_ *= cells_[k] = points_[k] - 1;
    least_[k] = std::numeric_limits<double>::infinity();
    most_[k] = -least_[k];
  }
  const auto d = static_cast<std::size_t>(dimension_);
  if (places_.size() != all * d) throw std::invalid_argument("a curvilinear grid without all of its places");
  for (std::size_t p = 0; p < all; ++p)
    for (std::size_t k = 0; k < d; ++k) {
      least_[k] = std::min(least_[k], places_[p * d + k]);
      most_[k] = std::max(most_[k], places_[p * d + k]);
    }
  double extent = 0;
  for (std::size_t k = 0; k < d; ++k) extent = std::max(extent, most_[k] - least_[k]);
  if (!std::isfinite(extent)) throw std::invalid_argument("a curvilinear grid with places that are not finite");
  tolerance_ = std::max(1e-12 * extent, rounding_);
  check_cells();
  sort_into_bins();
  constexpr std::size_t tried = 1000;
  const std::size_t stride = std::max<std::size_t>(1, count_ / tried);
  for (std::size_t number = 0; number < count_; number += stride) {
    const Vector x = cell(number).at({0.3, 0.6, dimension_ == 3 ? 0.8 : 0});
    const auto index = find(x);
    if (!index) throw std::invalid_argument(fmt::format("cell {} of a curvilinear grid is not found again", number));
    const Vector again = place(*index);
    Vector apart{};
    for (std::size_t k = 0; k < d; ++k) apart[k] = again[k] - x[k];
    residual_ = std::max(residual_, length_of(dimension_, apart));
  }
}

CurvedGrid::Cell CurvedGrid::cell(std::size_t number) const {
  Cell result;
  result.dimension = dimension_;
  std::array<std::size_t, max_dimension> at{};
  for (int k = 0; k < dimension_; ++k) at[k] = number % cells_[k], number /= cells_[k];
  for (int c = 0; c < result.corners(); ++c) {
    std::size_t point = 0, stride = 1;
    for (int k = 0; k < dimension_; ++k) {
      point += (at[k] + (static_cast<unsigned>(c) >> k & 1)) * stride;
      stride *= points_[k];
    }
    for (int k = 0; k < dimension_; ++k) {
      const double x = places_[point * static_cast<std::size_t>(dimension_) + static_cast<std::size_t>(k)];
      result.corner[c][k] = x;
      result.least[k] = c == 0 ? x : std::min(result.least[k], x);
      result.most[k] = c == 0 ? x : std::max(result.most[k], x);
    }
  }
  return result;
}

void CurvedGrid::check_cells() const {
  const double sign = determinant(dimension_, cell(0).slopes({})) < 0 ? -1 : 1;
  for (std::size_t number = 0; number < count_; ++number) {
    if (cell(number).is_sound(sign)) continue;
    const std::size_t i = number % cells_[0], j = number / cells_[0] % cells_[1], k = number / cells_[0] / cells_[1];
    throw std::invalid_argument(fmt::format("the cell [{}, {}{}] (counted from 0) is flat or folded", i, j,
                                            dimension_ == 3 ? fmt::format(", {}", k) : ""));
  }
}

std::array<std::size_t, max_dimension> CurvedGrid::bin_of(const Vector& x) const {
  std::array<std::size_t, max_dimension> bin{};
  for (int k = 0; k < dimension_; ++k) {
    const double part = (x[k] - least_[k]) / (most_[k] - least_[k]) * static_cast<double>(bins_[k]);
    bin[k] = static_cast<std::size_t>(std::clamp(part, 0., static_cast<double>(bins_[k] - 1)));
  }
  return bin;
}

/// use(bin) for every box that a cell has a part in.
template <class Use>
void CurvedGrid::each_bin(std::size_t number, const Use& use) const {
  Cell one = cell(number);
  for (int k = 0; k < dimension_; ++k) one.least[k] -= tolerance_, one.most[k] += tolerance_;
  const auto first = bin_of(one.least), last = bin_of(one.most);
  for (std::size_t c = first[2]; c <= last[2]; ++c)
    for (std::size_t b = first[1]; b <= last[1]; ++b)
      for (std::size_t a = first[0]; a <= last[0]; ++a) use((c * bins_[1] + b) * bins_[0] + a);
}

void CurvedGrid::sort_into_bins() {
  const auto along =
      static_cast<std::size_t>(std::ceil(std::pow(static_cast<double>(count_), 1. / static_cast<double>(dimension_))));
  for (std::size_t each = along;; each /= 2) {  // cells that are long and oblique may lie in very many boxes
    for (int k = 0; k < dimension_; ++k) bins_[k] = std::max<std::size_t>(1, each);
    std::size_t entries = 0;
    for (std::size_t number = 0; number < count_; ++number) {
      Cell one = cell(number);
      for (int k = 0; k < dimension_; ++k) one.least[k] -= tolerance_, one.most[k] += tolerance_;
      const auto first = bin_of(one.least), last = bin_of(one.most);
      std::size_t boxes = 1;
      for (int k = 0; k < dimension_; ++k) boxes *= last[k] - first[k] + 1;
      entries += boxes;
    }
    if (entries <= 16 * count_ || each <= 1) break;
  }
  first_.assign(bins_[0] * bins_[1] * bins_[2] + 1, 0);
  for (std::size_t number = 0; number < count_; ++number) each_bin(number, [&](std::size_t bin) { ++first_[bin + 1]; });
  for (std::size_t bin = 1; bin < first_.size(); ++bin) first_[bin] += first_[bin - 1];
  in_bin_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t number = 0; number < count_; ++number)
    each_bin(number, [&](std::size_t bin) { in_bin_[next[bin]++] = static_cast<std::uint32_t>(number); });
}

std::optional<Vector> CurvedGrid::find(const Vector& x) const {
  for (int k = 0; k < dimension_; ++k)
    if (!(x[k] >= least_[k] - tolerance_ && x[k] <= most_[k] + tolerance_)) return std::nullopt;
  const auto bin = bin_of(x);
  const std::size_t box = (bin[2] * bins_[1] + bin[1]) * bins_[0] + bin[0];
  std::optional<Vector> best;
  double nearest = tolerance_;
  for (std::size_t entry = first_[box]; entry < first_[box + 1]; ++entry) {
    const Cell one = cell(in_bin_[entry]);
    bool may_be = true;
    for (int k = 0; k < dimension_; ++k)
      may_be = may_be && x[k] >= one.least[k] - tolerance_ && x[k] <= one.most[k] + tolerance_;
    if (!may_be) continue;
    auto s = one.solve(x);
    if (!s) continue;
    double beyond = 0;
    for (int k = 0; k < dimension_; ++k) {
      beyond = std::max({beyond, -(*s)[k], (*s)[k] - 1});
      (*s)[k] = std::clamp((*s)[k], 0., 1.);
    }
    if (beyond * one.size() > nearest || (best && beyond * one.size() == nearest)) continue;
    nearest = beyond * one.size();
    std::size_t number = in_bin_[entry];
    for (int k = 0; k < dimension_; ++k) {
      (*s)[k] += static_cast<double>(number % cells_[k]);
      number /= cells_[k];
    }
    best = s;
    if (beyond <= 0) break;
  }
  return best;
}

/// The cell of fractional indices, and where in it they are.
std::size_t CurvedGrid::cell_at(const Vector& index, Vector& inside) const {
  std::size_t number = 0, stride = 1;
  for (int k = 0; k < dimension_; ++k) {
    const double at = std::clamp(index[k], 0., static_cast<double>(cells_[k]));
    const auto i = std::min(static_cast<std::size_t>(at), cells_[k] - 1);
    inside[k] = at - static_cast<double>(i);
    number += i * stride;
    stride *= cells_[k];
  }
  return number;
}

Vector CurvedGrid::place(const Vector& index) const {
  Vector inside{};
  const Cell one = cell(cell_at(index, inside));
  return one.at(inside);
}

CurvedGrid::Matrix CurvedGrid::slopes(const Vector& index) const {
  Vector inside{};
  const Cell one = cell(cell_at(index, inside));
  return inverse(dimension_, one.slopes(inside));
}

bool CurvedGrid::same_places(const CurvedGrid& other) const {
  if (points_ != other.points_ || places_.size() != other.places_.size()) return false;
  for (std::size_t i = 0; i < places_.size(); ++i)
    if (!(std::abs(places_[i] - other.places_[i]) <= rounding_ + other.rounding_)) return false;
  return true;
}

}  // namespace gaussdrift
