#include "farfield/general/polynomials.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/arguments.hpp"

namespace farfield::detail {

namespace {

/// chi_j(z) = T_j(z), times sqrt(2) for j > 0: orthonormal in the mean over the Chebyshev points of [-1, 1].
void chebyshev_values(double z, int degree, double* values) {
  double before = 1, now = z;
  values[0] = 1;
  for (int j = 1; j <= degree; ++j) {
    values[j] = std::numbers::sqrt2 * now;
    const double after = 2 * z * now - before;
    before = now;
    now = after;
  }
}

/// Chebyshev points of [-1, 1].
std::vector<double> chebyshev_points(int count) {
  std::vector<double> points(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i)
    points[static_cast<std::size_t>(i)] = -std::cos(std::numbers::pi * (2 * i + 1) / (2 * count));
  return points;
}

/// Gauss's rule for the mean over [-1/2, 1/2].
struct GaussRule {
  std::vector<double> points, weights;

  explicit GaussRule(int count) {
    for (int i = 0; i < count; ++i) {
      double t = -std::cos(std::numbers::pi * (i + 0.75) / (count + 0.5)), slope = 1;
      for (int step = 0; step < 100; ++step) {  // Newton's method for a zero of P_count
        double before = 0, now = 1;
        for (int a = 0; a < count; ++a) {
          const double after = ((2 * a + 1) * t * now - a * before) / (a + 1);
          before = now;
          now = after;
        }
        slope = count * (t * now - before) / (t * t - 1);
        const double move = now / slope;
        t -= move;
        if (std::abs(move) < 1e-16) break;
      }
      points.push_back(t / 2);
      weights.push_back(1 / ((1 - t * t) * slope * slope));
    }
  }
  /// [point][a]: psi_a at the points.
  RowMatrix values(int degree) const {
    RowMatrix all(static_cast<Eigen::Index>(points.size()), degree + 1);
    for (std::size_t i = 0; i < points.size(); ++i)
      legendre_values(points[i], degree, all.row(static_cast<Eigen::Index>(i)).data());
    return all;
  }
  /// The same times the weights.
  RowMatrix weighted(int degree) const {
    RowMatrix all = values(degree);
    for (std::size_t i = 0; i < weights.size(); ++i) all.row(static_cast<Eigen::Index>(i)) *= weights[i];
    return all;
  }
};

}  // namespace

void legendre_values(double x, int degree, double* values) {
  const double t = 2 * x;
  double before = 0, now = 1;
  for (int a = 0; a <= degree; ++a) {
    values[a] = std::sqrt(2.0 * a + 1) * now;
    const double after = ((2 * a + 1) * t * now - a * before) / (a + 1);
    before = now;
    now = after;
  }
}

RowMatrix legendre_restriction(int degree, int half) {
  const GaussRule rule(degree + 1);
  RowMatrix parent(degree + 1, degree + 1);
  for (int i = 0; i <= degree; ++i)
    legendre_values(0.5 * rule.points[static_cast<std::size_t>(i)] + (half == 0 ? -0.25 : 0.25), degree,
                    parent.row(i).data());
  return parent.transpose() * rule.weighted(degree);
}

unsigned Products::parity(const Degrees& degrees) {
  return (degrees[0] & 1U) | (degrees[1] & 1U) << 1U | (degrees[2] & 1U) << 2U;
}

int Products::order_of(const Degrees& degrees, bool total) {
  return total ? degrees[0] + degrees[1] + degrees[2] : std::max({degrees[0], degrees[1], degrees[2]});
}

Products::Products(int dimensions, int highest, bool of_total_degree, bool by_parity)
    : dimension(dimensions), order(highest), total(of_total_degree) {
  for (int a = 0; a <= order; ++a)
    for (int b = 0; b <= order; ++b)
      for (int c = 0; c <= (dimension == 3 ? order : 0); ++c) {
        const Degrees some{static_cast<std::uint8_t>(a), static_cast<std::uint8_t>(b), static_cast<std::uint8_t>(c)};
        if (order_of(some, total) <= order) degrees.push_back(some);
      }
  part_begin.push_back(0);
  if (by_parity) {
    std::stable_sort(degrees.begin(), degrees.end(),
                     [](const Degrees& a, const Degrees& b) { return parity(a) < parity(b); });
    for (std::size_t i = 1; i < degrees.size(); ++i)
      if (parity(degrees[i]) != parity(degrees[i - 1])) part_begin.push_back(i);
  }
  part_begin.push_back(degrees.size());
}

void product_values(const Products& products, const double* point, double* values) {
  double factor[3][64] = {};
  factor[2][0] = 1;
  for (int l = 0; l < products.dimension; ++l) legendre_values(point[l], products.order, factor[l]);
  for (std::size_t k = 0; k < products.size(); ++k) {
    const Products::Degrees& a = products.degrees[k];
    values[k] = factor[0][a[0]] * factor[1][a[1]] * factor[2][a[2]];
  }
}

RowMatrix product_restriction(const Products& parent, const Products& child, unsigned octant) {
  const int degree = std::max(parent.order, child.order);
  RowMatrix axis[3];
  for (unsigned l = 0; l < 3; ++l)
    axis[l] = l < static_cast<unsigned>(parent.dimension)
                  ? legendre_restriction(degree, static_cast<int>(octant >> l & 1U))
                  : RowMatrix::Identity(1, 1);
  RowMatrix matrix(static_cast<Eigen::Index>(parent.size()), static_cast<Eigen::Index>(child.size()));
  for (std::size_t a = 0; a < parent.size(); ++a)
    for (std::size_t b = 0; b < child.size(); ++b) {
      const auto &of = parent.degrees[a], &in = child.degrees[b];
      matrix(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)) =
          axis[0](of[0], in[0]) * axis[1](of[1], in[1]) * axis[2](of[2], in[2]);
    }
  return matrix;
}

namespace {

/// product[j][a][b]: coefficient of psi_a(x) psi_b(y) in chi_j(x - y).
/// It is 0 unless a + b <= j, and a + b and j are both even or both odd.
struct DifferenceTable {
  static constexpr int degrees = 41;
  std::vector<double> product = std::vector<double>(std::size_t{degrees} * degrees * degrees);

  DifferenceTable() {
    const GaussRule rule(degrees);
    const RowMatrix weighted = rule.weighted(degrees - 1);
    std::vector<RowMatrix> of_degree(degrees, RowMatrix(degrees, degrees));
    double chi[degrees];
    for (int i = 0; i < degrees; ++i)
      for (int k = 0; k < degrees; ++k) {
        chebyshev_values(rule.points[static_cast<std::size_t>(i)] - rule.points[static_cast<std::size_t>(k)],
                         degrees - 1, chi);
        for (std::size_t j = 0; j < degrees; ++j) of_degree[j](i, k) = chi[j];
      }
    for (int j = 0; j < degrees; ++j) {
      const RowMatrix all = weighted.transpose() * of_degree[static_cast<std::size_t>(j)] * weighted;
      for (int a = 0; a <= j; ++a)
        for (int b = (j - a) % 2; a + b <= j; b += 2) at(j, a, b) = all(a, b);
    }
  }
  double& at(int j, int a, int b) { return product[static_cast<std::size_t>((j * degrees + a) * degrees + b)]; }
  double at(int j, int a, int b) const { return product[static_cast<std::size_t>((j * degrees + a) * degrees + b)]; }
};

const DifferenceTable& difference_table() {
  static const DifferenceTable table;
  return table;
}

/// Values of the kernel at differences side * (offset + z), z by axis.
std::vector<double> values_at(const KernelData& kernel, int dimension, double side, const std::array<int, 3>& offset,
                              const std::vector<std::array<double, 3>>& places) {
  std::vector<double> values(places.size());
  double difference[3][kernel_block];
  const double* const rows[3] = {difference[0], difference[1], difference[2]};
  for (std::size_t begin = 0; begin < places.size(); begin += kernel_block) {
    const std::size_t count = std::min(kernel_block, places.size() - begin);
    for (std::size_t l = 0; l < static_cast<std::size_t>(dimension); ++l)
      for (std::size_t i = 0; i < count; ++i) difference[l][i] = side * (offset[l] + places[begin + i][l]);
    kernel_values(kernel, dimension, rows, count, values.data() + begin);
    for (std::size_t i = 0; i < count; ++i)
      if (!std::isfinite(values[begin + i])) {
        std::string place;
        for (std::size_t l = 0; l < static_cast<std::size_t>(dimension); ++l)
          place += (l == 0 ? "" : ", ") + gaussdrift::core::text(difference[l][i]);
        throw InvalidArgument("farfield: the kernel is not finite at the difference (" + place + ")");
      }
  }
  return values;
}

}  // namespace

DifferenceInterpolant::DifferenceInterpolant(const KernelData& kernel, int dimension, double side,
                                             const std::array<int, 3>& offset, int order)
    : dimension_(dimension), order_(order) {
  const int count = order + 1, last = dimension == 3 ? count : 1;
  const std::vector<double> points = chebyshev_points(count);
  std::vector<std::array<double, 3>> places;
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < count; ++j)
      for (int k = 0; k < last; ++k)
        places.push_back({points[static_cast<std::size_t>(i)], points[static_cast<std::size_t>(j)],
                          points[static_cast<std::size_t>(k)]});
  coefficients_ = values_at(kernel, dimension, side, offset, places);
  for (const double value : coefficients_) size_ = std::max(size_, std::abs(value));
  // Values become coefficients, axis by axis: each time the last axis is transformed and becomes the first.
  RowMatrix transform(count, count);
  for (int i = 0; i < count; ++i) chebyshev_values(points[static_cast<std::size_t>(i)], order, transform.row(i).data());
  transform = RowMatrix(transform.transpose() / count);
  for (int l = 0; l < 3; ++l) {
    const int extent = l == 0 ? last : count;
    const Eigen::Map<const RowMatrix> before(coefficients_.data(),
                                             static_cast<Eigen::Index>(coefficients_.size()) / extent, extent);
    const RowMatrix after = extent == count && (l > 0 || dimension == 3) ? RowMatrix(transform * before.transpose())
                                                                         : RowMatrix(before.transpose());
    coefficients_.assign(after.data(), after.data() + after.size());
  }
  // At places that have nothing to do with the nodes: an additive sequence in every axis.
  std::vector<std::array<double, 3>> elsewhere(200);
  constexpr double steps[3] = {0.8191725133961645, 0.6710436067037893, 0.5497004779019703};
  for (std::size_t i = 0; i < elsewhere.size(); ++i)
    for (std::size_t l = 0; l < 3; ++l) {
      const double along = static_cast<double>(i + 1) * steps[l];
      elsewhere[i][l] = 2 * (along - std::floor(along)) - 1;
    }
  const std::vector<double> exact = values_at(kernel, dimension, side, offset, elsewhere);
  double squares = 0;
  std::vector<double> factor[3];
  for (auto& values : factor) values.assign(static_cast<std::size_t>(count), 1);
  for (std::size_t i = 0; i < elsewhere.size(); ++i) {
    for (int l = 0; l < dimension; ++l)
      chebyshev_values(elsewhere[i][static_cast<std::size_t>(l)], order, factor[l].data());
    double sum = 0;
    const double* at = coefficients_.data();
    for (int a = 0; a < count; ++a)
      for (int b = 0; b < count; ++b) {
        double along = 0;
        for (int c = 0; c < last; ++c) along += *at++ * factor[2][static_cast<std::size_t>(c)];
        sum += along * factor[0][static_cast<std::size_t>(a)] * factor[1][static_cast<std::size_t>(b)];
      }
    squares += (sum - exact[i]) * (sum - exact[i]);
  }
  error_ = std::sqrt(squares / static_cast<double>(elsewhere.size()));
}

RowMatrix DifferenceInterpolant::coefficients(const Products& products) const {
  const DifferenceTable& table = difference_table();
  const int count = order_ + 1, last = dimension_ == 3 ? count : 1;
  const std::size_t degrees = static_cast<std::size_t>(products.order) + 1;
  const auto size = static_cast<std::size_t>(count);
  const std::size_t plane = size * static_cast<std::size_t>(last);
  const auto allowed = [&](std::size_t a, std::size_t b) {
    return !products.total || a + b <= static_cast<std::size_t>(products.order);
  };
  // First axis: [a1][b1][j2][j3].
  std::vector<double> first(degrees * degrees * plane, 0.0);
  for (std::size_t a = 0; a < degrees; ++a)
    for (std::size_t b = 0; b < degrees; ++b) {
      double* const to = first.data() + (a * degrees + b) * plane;
      for (std::size_t j = a + b; j < size; j += 2) {
        const double factor = table.at(static_cast<int>(j), static_cast<int>(a), static_cast<int>(b));
        const double* const from = coefficients_.data() + j * plane;
        for (std::size_t i = 0; i < plane; ++i) to[i] += factor * from[i];
      }
    }
  const auto count_of = static_cast<Eigen::Index>(products.size());
  RowMatrix result(count_of, count_of);
  // Where a product stands, by its degrees.
  std::vector<std::int32_t> place(degrees * degrees * degrees, -1);
  for (std::size_t k = 0; k < products.size(); ++k) {
    const auto& a = products.degrees[k];
    place[(a[0] * degrees + a[1]) * degrees + a[2]] = static_cast<std::int32_t>(k);
  }
  const auto line = static_cast<std::size_t>(last);
  std::vector<double> second(line);
  const std::size_t highest = dimension_ == 3 ? degrees : 1;
  for (std::size_t a1 = 0; a1 < degrees; ++a1)
    for (std::size_t b1 = 0; b1 < degrees; ++b1)
      for (std::size_t a2 = 0; a2 < degrees && allowed(a1, a2); ++a2)
        for (std::size_t b2 = 0; b2 < degrees && allowed(b1, b2); ++b2) {
          std::fill(second.begin(), second.end(), 0.0);
          const double* const from = first.data() + (a1 * degrees + b1) * plane;
          for (std::size_t j = a2 + b2; j < size; j += 2) {
            const double factor = table.at(static_cast<int>(j), static_cast<int>(a2), static_cast<int>(b2));
            for (std::size_t i = 0; i < line; ++i) second[i] += factor * from[j * line + i];
          }
          for (std::size_t a3 = 0; a3 < highest && allowed(a1 + a2, a3); ++a3)
            for (std::size_t b3 = 0; b3 < highest && allowed(b1 + b2, b3); ++b3) {
              double sum = 0;
              for (std::size_t j = a3 + b3; j < line; j += 2)
                sum += second[j] * table.at(static_cast<int>(j), static_cast<int>(a3), static_cast<int>(b3));
              result(place[(a1 * degrees + a2) * degrees + a3], place[(b1 * degrees + b2) * degrees + b3]) = sum;
            }
        }
  return result;
}

}  // namespace farfield::detail
