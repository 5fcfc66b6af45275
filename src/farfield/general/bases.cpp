#include "farfield/general/bases.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <numeric>

#include "farfield/check.hpp"

namespace farfield::detail {

namespace {

// Shares of the square of the error that a level is allowed.
constexpr double of_interpolation = 0.1, of_products = 0.15, of_functions = 0.1, of_couplings = 0.4;

constexpr int highest_interpolated = 40;  // degree in differences
constexpr int highest_order[4] = {0, 0, 34, 18};

/// C = A B by the fastest instructions. B's rows are copied to where they can be read past their end.
RowMatrix multiply(const RowMatrix& a, const RowMatrix& b) {
  Buffer<double> right(static_cast<std::size_t>(b.size()) + padding, 0.0);
  std::copy(b.data(), b.data() + b.size(), right.begin());
  RowMatrix c = RowMatrix::Zero(a.rows(), b.cols());
  if (c.size() > 0)
    fastest_kernels().product({static_cast<std::size_t>(a.rows()), static_cast<std::size_t>(a.cols()),
                               static_cast<std::size_t>(b.cols()), a.data(), static_cast<std::size_t>(a.cols()),
                               right.data(), static_cast<std::size_t>(b.cols()), c.data(),
                               static_cast<std::size_t>(c.cols())});
  return c;
}

}  // namespace

RowMatrix times_functions(const RowMatrix& rows, const LevelBasis& basis) {
  if (basis.identity) return rows;
  RowMatrix result(rows.rows(), static_cast<Eigen::Index>(basis.rank));
  for (const LevelBasis::Part& part : basis.parts) {
    const RowMatrix some = multiply(rows.middleCols(part.begin, part.count), part.functions);
    for (std::size_t k = 0; k < part.columns.size(); ++k)
      result.col(part.columns[k]) = some.col(static_cast<Eigen::Index>(k));
  }
  return result;
}

namespace {

/// An offset whose coefficients are computed; those of others follow by exchanging and reversing axes.
struct Canonical {
  std::array<int, 3> offset{};
  double weight = 0;  // share of the level's pairs of points
  std::optional<DifferenceInterpolant> interpolant{};
  RowMatrix coefficients{};  // in the products of the level
};

/// One coupling matrix: offsets that differ in signs.
struct Unsigned {
  std::array<int, 3> offset{};
  std::size_t canonical = 0;
  std::array<int, 3> axis{0, 1, 2};  // axis l is this axis of the canonical offset
  double weight = 0;
};

class LevelBuilder {
 public:
  LevelBuilder(const KernelData& kernel, int dimension, const LevelTask& task, const BasisOptions& options)
      : kernel_(kernel), dimension_(dimension), task_(task), options_(options) {}

  /// parent  null on the first level that has bases; else its functions times the square roots of their weights
  void build(const LevelBasis* parent, const RowMatrix& parent_weighted);
  LevelBasis basis;
  RowMatrix weighted;  // for the children

 private:
  void classify();
  void interpolate();
  int order_needed(const LevelBasis* parent, const RowMatrix& parent_weighted);
  void compress(const LevelBasis* parent, const RowMatrix& parent_weighted);
  RowMatrix coefficients_of(const Unsigned& some) const;
  void couple();
  [[noreturn]] void refuse(const Canonical& canonical, const char* what) const;

  const KernelData& kernel_;
  const int dimension_;
  const LevelTask& task_;
  const BasisOptions& options_;
  std::vector<Canonical> canonical_;
  std::vector<Unsigned> unsigned_;
};

void LevelBuilder::classify() {
  std::map<std::array<int, 3>, std::size_t> of_canonical, of_unsigned;
  double all = 0;
  for (const GeneralOffset& offset : task_.offsets) all += offset.far_pairs;
  for (const GeneralOffset& offset : task_.offsets) {
    std::array<int, 3> size = offset.offset;
    unsigned reflection = 0;
    if (kernel_.radial())
      for (std::size_t l = 0; l < 3; ++l)
        if (size[l] < 0) {
          size[l] = -size[l];
          reflection |= 1U << l;
        }
    const auto [at, is_new] = of_unsigned.try_emplace(size, unsigned_.size());
    if (is_new) {
      Unsigned some{.offset = size};
      std::array<int, 3> sorted = size;
      if (kernel_.radial()) {
        std::array<int, 3> order{0, 1, 2};
        std::stable_sort(order.begin(), order.begin() + dimension_, [&](int a, int b) {
          return size[static_cast<std::size_t>(a)] > size[static_cast<std::size_t>(b)];
        });
        for (std::size_t place = 0; place < 3; ++place) {
          sorted[place] = size[static_cast<std::size_t>(order[place])];
          some.axis[static_cast<std::size_t>(order[place])] = static_cast<int>(place);
        }
      }
      const auto [known, first] = of_canonical.try_emplace(sorted, canonical_.size());
      if (first) canonical_.push_back({.offset = sorted});
      some.canonical = known->second;
      unsigned_.push_back(some);
    }
    const double weight = offset.far_pairs / all;
    unsigned_[at->second].weight += weight;
    canonical_[unsigned_[at->second].canonical].weight += weight;
    basis.uses.push_back({static_cast<std::uint32_t>(at->second), reflection});
  }
}

void LevelBuilder::refuse(const Canonical& canonical, const char* what) const {
  double nearest = 0;
  for (const int k : canonical.offset) nearest += std::pow(std::max(0, std::abs(k) - 1), 2);
  throw ToleranceError(std::string("farfield: ") + what + " between cubes of side " + text(task_.side) +
                       " at distance " + text(task_.side * std::sqrt(nearest)) +
                       ": the kernel is not smooth enough there for the tolerance. Raise the tolerance, or leave the "
                       "method to direct");
}

/// Differences are interpolated to an order that is found by its error.
void LevelBuilder::interpolate() {
  const double classes = static_cast<double>(canonical_.size());
  int order = 6;
  for (Canonical& canonical : canonical_) {
    // Offsets with few pairs may err more.
    const double share = std::min(100.0, 1 / (classes * canonical.weight));
    const double allowed = task_.allowed * std::sqrt(of_interpolation * share);
    order = std::max(6, order - 4);
    double before = HUGE_VAL;
    for (;;) {
      canonical.interpolant.emplace(kernel_, dimension_, task_.side, canonical.offset, order);
      const double error = canonical.interpolant->error();
      if (error <= std::max(allowed, 1e-14 * canonical.interpolant->size())) break;
      // Orders are skipped by what the last ones have gained.
      if (order >= highest_interpolated) refuse(canonical, "interpolation does not converge");
      const double gain = std::log(before / error);
      const double missing = std::log(error / allowed);
      const int more = before < HUGE_VAL && gain > 0 ? static_cast<int>(std::ceil(0.8 * 2 * missing / gain)) : 2;
      order = std::min(highest_interpolated, order + std::clamp(more, 1, 8));
      before = more > 2 ? HUGE_VAL : error;
    }
  }
}

/// The lowest order with which what is cut off is small enough, in the own couplings and in the parent's functions.
int LevelBuilder::order_needed(const LevelBasis* parent, const RowMatrix& parent_weighted) {
  const bool total = options_.recompress;
  int needed = 0;
  if (parent) {
    const Products& of = *parent->products;
    const RowMatrix restricted =
        multiply(product_restriction(of, of, 0).transpose(), parent_weighted);  // all octants are alike but for signs
    std::vector<double> energy(static_cast<std::size_t>(of.order) + 1);
    for (std::size_t b = 0; b < of.size(); ++b)
      energy[static_cast<std::size_t>(Products::order_of(of.degrees[b], total))] +=
          restricted.row(static_cast<Eigen::Index>(b)).squaredNorm();
    double left = 0;
    needed = of.order;
    while (needed > 0 && left + energy[static_cast<std::size_t>(needed)] <= of_products / 4)
      left += energy[static_cast<std::size_t>(needed--)];
  }
  if (canonical_.empty()) return needed;
  const double allowed = of_products * task_.allowed * task_.allowed;
  const int highest = highest_order[dimension_];
  int tried = 8;
  for (;; tried += 3) {
    const Products products(dimension_, std::min(tried, highest), total, kernel_.radial());
    std::vector<double> energy(static_cast<std::size_t>(products.order) + 1);  // by the higher order of the two sides
    for (Canonical& canonical : canonical_) {
      canonical.coefficients = canonical.interpolant->coefficients(products);
      for (std::size_t a = 0; a < products.size(); ++a)
        for (std::size_t b = 0; b < products.size(); ++b) {
          const int order =
              std::max(Products::order_of(products.degrees[a], total), Products::order_of(products.degrees[b], total));
          const double entry = canonical.coefficients(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b));
          energy[static_cast<std::size_t>(order)] += canonical.weight * entry * entry;
        }
    }
    // What lies beyond the last order falls at least as it did from the last but one to the last.
    const double last = energy[static_cast<std::size_t>(products.order)],
                 last_but_two = energy[static_cast<std::size_t>(products.order) - 2];
    const double fall = std::sqrt(last / std::max(last_but_two, 1e-300));
    double beyond = fall < 0.9 ? last * fall / (1 - fall) : HUGE_VAL;
    if (last == 0) beyond = 0;
    int order = products.order;
    while (order > 0 && beyond + energy[static_cast<std::size_t>(order)] <= allowed)
      beyond += energy[static_cast<std::size_t>(order--)];
    double floor = 0;  // of rounding
    for (const Canonical& canonical : canonical_) floor = std::max(floor, 1e-14 * canonical.interpolant->size());
    if (beyond <= std::max(allowed, floor * floor)) return std::max(needed, order);
    if (tried >= highest) refuse(canonical_.front(), "too high an order would be needed");
  }
}

/// Coefficients of an offset from those of the canonical one, in the products of the level.
RowMatrix LevelBuilder::coefficients_of(const Unsigned& some) const {
  const Products& products = *basis.products;
  const RowMatrix& from = canonical_[some.canonical].coefficients;
  if (some.axis == std::array<int, 3>{0, 1, 2}) return from;
  std::map<Products::Degrees, Eigen::Index> place;
  for (std::size_t k = 0; k < products.size(); ++k) place[products.degrees[k]] = static_cast<Eigen::Index>(k);
  std::vector<Eigen::Index> index(products.size());
  for (std::size_t k = 0; k < products.size(); ++k) {
    Products::Degrees moved{};
    for (std::size_t l = 0; l < 3; ++l) moved[static_cast<std::size_t>(some.axis[l])] = products.degrees[k][l];
    index[k] = place.at(moved);
  }
  RowMatrix result(from.rows(), from.cols());
  for (std::size_t a = 0; a < index.size(); ++a)
    for (std::size_t b = 0; b < index.size(); ++b)
      result(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)) = from(index[a], index[b]);
  return result;
}

/// The functions: those combinations of products that the couplings, and the parent's functions, see most of. They are the
/// singular vectors of all of them side by side, each divided by the error that it is allowed.
void LevelBuilder::compress(const LevelBasis* parent, const RowMatrix& parent_weighted) {
  const Products& products = *basis.products;
  const auto size = static_cast<Eigen::Index>(products.size());
  RowMatrix restricted;
  if (parent) restricted = multiply(product_restriction(*parent->products, products, 0).transpose(), parent_weighted);
  // One part for every parity: functions of different parities have nothing to do with each other.
  const std::size_t part_count = products.part_begin.size() - 1;
  const auto begin_of = [&](std::size_t part) { return static_cast<Eigen::Index>(products.part_begin[part]); };
  const auto count_of = [&](std::size_t part) { return begin_of(part + 1) - begin_of(part); };
  std::vector<RowMatrix> gram;
  for (std::size_t part = 0; part < part_count; ++part)
    gram.emplace_back(RowMatrix::Zero(count_of(part), count_of(part)));
  const auto add = [&](const RowMatrix& matrix, double factor) {
    for (std::size_t part = 0; part < part_count; ++part) {
      const RowMatrix rows = matrix.middleRows(begin_of(part), count_of(part));
      gram[part] += factor * multiply(rows, rows.transpose());
    }
  };
  for (const Unsigned& some : unsigned_) {
    const RowMatrix coefficients = coefficients_of(some);
    const double factor = some.weight / (task_.allowed * task_.allowed);
    add(coefficients, factor);
    // Sums over both signs of an offset make both sides alike where k(-z) = k(z).
    if (!kernel_.radial()) add(coefficients.transpose(), factor);
  }
  if (parent && kernel_.radial()) add(restricted, 1);
  if (parent && !kernel_.radial())
    for (unsigned octant = 0; octant < 1U << dimension_; ++octant)
      add(multiply(product_restriction(*parent->products, products, octant).transpose(), parent_weighted),
          std::ldexp(1.0, -dimension_));
  struct Function {
    double weight;
    std::size_t part;
    Eigen::VectorXd vector;
  };
  std::vector<Function> found;
  for (std::size_t part = 0; part < part_count; ++part) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver{Eigen::MatrixXd(gram[part])};
    for (Eigen::Index k = 0; k < count_of(part); ++k)
      found.push_back({std::max(0.0, solver.eigenvalues()[k]), part, solver.eigenvectors().col(k)});
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Function& a, const Function& b) { return a.weight > b.weight; });
  double dropped = 0;
  while (found.size() > 1 && dropped + found.back().weight <= of_functions / 2) {
    dropped += found.back().weight;
    found.pop_back();
  }
  basis.rank = found.size();
  basis.functions = RowMatrix::Zero(size, static_cast<Eigen::Index>(basis.rank));
  weighted.resize(size, static_cast<Eigen::Index>(basis.rank));
  for (std::size_t k = 0; k < found.size(); ++k) {
    const auto column = static_cast<Eigen::Index>(k);
    const std::size_t begin = products.part_begin[found[k].part];
    basis.functions.col(column).segment(static_cast<Eigen::Index>(begin), found[k].vector.size()) = found[k].vector;
    basis.parity.push_back(kernel_.radial() ? Products::parity(products.degrees[begin]) : 0);
    weighted.col(column) = std::sqrt(found[k].weight) * basis.functions.col(column);
  }
  for (std::size_t part = 0; part < part_count; ++part) {
    LevelBasis::Part& made = basis.parts.emplace_back();
    made.begin = begin_of(part);
    made.count = count_of(part);
    for (std::size_t k = 0; k < found.size(); ++k)
      if (found[k].part == part) made.columns.push_back(static_cast<Eigen::Index>(k));
    made.functions.resize(made.count, static_cast<Eigen::Index>(made.columns.size()));
    for (std::size_t k = 0; k < made.columns.size(); ++k)
      made.functions.col(static_cast<Eigen::Index>(k)) =
          basis.functions.col(made.columns[k]).segment(made.begin, made.count);
  }
}

/// How many of the first functions each coupling takes. The sum of size^2 is smallest for the error where all of them
/// gain as much by one function more.
std::vector<std::size_t> coupling_sizes(const std::vector<RowMatrix>& matrices, const std::vector<Unsigned>& some,
                                        double allowed) {
  std::vector<std::vector<double>> left(matrices.size());  // [size]: squares outside the first rows and columns
  for (std::size_t k = 0; k < matrices.size(); ++k) {
    const Eigen::Index rank = matrices[k].rows();
    left[k].assign(static_cast<std::size_t>(rank) + 1, 0.0);
    for (Eigen::Index size = rank; size-- > 0;)
      left[k][static_cast<std::size_t>(size)] = left[k][static_cast<std::size_t>(size) + 1] +
                                                matrices[k].row(size).head(size + 1).squaredNorm() +
                                                matrices[k].col(size).head(size).squaredNorm();
  }
  std::vector<std::size_t> sizes(matrices.size());
  const auto error_of = [&](double price) {
    double error = 0;
    for (std::size_t k = 0; k < matrices.size(); ++k) {
      double best = HUGE_VAL;
      for (std::size_t size = 0; size < left[k].size(); ++size) {
        const double cost = left[k][size] + price * static_cast<double>(size * size);
        if (cost < best) {
          best = cost;
          sizes[k] = size;
        }
      }
      error += some[k].weight * left[k][sizes[k]];
    }
    return error;
  };
  double low = std::log(1e-12 * allowed + 1e-300), high = std::log(allowed + 1e-300);
  if (error_of(std::exp(high)) <= allowed) return sizes;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (error_of(std::exp(middle)) <= allowed ? low : high) = middle;
  }
  error_of(std::exp(low));
  return sizes;
}

void LevelBuilder::couple() {
  std::vector<RowMatrix> matrices;
  for (const Unsigned& some : unsigned_) {
    const RowMatrix coefficients = coefficients_of(some);
    // The functions' transposed, times the coefficients, times the functions.
    matrices.push_back(RowMatrix(times_functions(times_functions(coefficients, basis).transpose(), basis).transpose()));
  }
  std::vector<std::size_t> sizes(matrices.size(), basis.rank);
  if (options_.recompress) sizes = coupling_sizes(matrices, unsigned_, of_couplings * task_.allowed * task_.allowed);
  for (std::size_t k = 0; k < matrices.size(); ++k) {
    const auto size = static_cast<Eigen::Index>(sizes[k]);
    basis.matrices.push_back({matrices[k].topLeftCorner(size, size).transpose()});
  }
}

void LevelBuilder::build(const LevelBasis* parent, const RowMatrix& parent_weighted) {
  classify();
  interpolate();
  int order = options_.fixed_order;
  if (order == 0) order = order_needed(parent, parent_weighted);
  basis.products.emplace(dimension_, order, options_.recompress, kernel_.radial());
  const Products& products = *basis.products;
  for (Canonical& canonical : canonical_) canonical.coefficients = canonical.interpolant->coefficients(products);
  if (options_.recompress) {
    compress(parent, parent_weighted);
  } else {
    basis.identity = true;
    basis.rank = products.size();
    for (const auto& degrees : products.degrees)
      basis.parity.push_back(kernel_.radial() ? Products::parity(degrees) : 0);
    // Weights of products, so that children know which orders they need: those of the couplings on the diagonal of what
    // compress() would look at.
    Eigen::VectorXd squares = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(products.size()));
    for (const Unsigned& some : unsigned_)
      squares += some.weight / (task_.allowed * task_.allowed) * coefficients_of(some).rowwise().squaredNorm();
    if (parent)
      squares += multiply(product_restriction(*parent->products, products, 0).transpose(), parent_weighted)
                     .rowwise()
                     .squaredNorm();
    weighted = squares.cwiseSqrt().asDiagonal();
  }
  if (parent)
    for (unsigned octant = 0; octant < 1U << dimension_; ++octant) {
      RowMatrix from;                        // rank of the parent x rank
      if (octant > 0 && kernel_.radial()) {  // the first one seen in a mirror
        from = basis.from_parent[0];
        for (Eigen::Index a = 0; a < from.rows(); ++a)
          for (Eigen::Index b = 0; b < from.cols(); ++b) {
            const unsigned odd =
                parent->parity[static_cast<std::size_t>(a)] ^ basis.parity[static_cast<std::size_t>(b)];
            if (std::popcount(odd & octant) % 2 == 1) from(a, b) = -from(a, b);
          }
      } else {
        from = times_functions(product_restriction(*parent->products, products, octant), basis);
        from = times_functions(from.transpose(), *parent).transpose().eval();
      }
      basis.from_parent.push_back(from);
      basis.to_parent.push_back(from.transpose());
    }
  couple();
}

}  // namespace

std::vector<LevelBasis> build_bases(const KernelData& kernel, int dimension, const std::vector<LevelTask>& tasks,
                                    const BasisOptions& options, std::size_t memory_limit) {
  std::vector<LevelBasis> bases(tasks.size());
  RowMatrix weighted;
  const LevelBasis* parent = nullptr;
  double bytes = 0;
  for (std::size_t level = 0; level < tasks.size(); ++level) {
    if (!tasks[level].needed) continue;
    LevelBuilder builder(kernel, dimension, tasks[level], options);
    builder.build(parent, weighted);
    bases[level] = std::move(builder.basis);
    weighted = std::move(builder.weighted);
    parent = &bases[level];
    for (const LevelBasis::Matrix& matrix : parent->matrices)
      bytes += 8.0 * static_cast<double>(matrix.transposed.size());
    check_memory("coupling matrices", bytes, memory_limit);
  }
  return bases;
}

}  // namespace farfield::detail
