// Window, filter and their errors; see fgtd/spread/filter.hpp.
#include "fgtd/spread/filter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <numbers>
#include <tuple>
#include <utility>

namespace fgtd::detail {
namespace {

constexpr double pi = std::numbers::pi;
// b / w: the widest lattice over all tolerances and derivatives, flat within 0.15; larger for windows with less than
// two nodes more than digits, whose jump 1/I_0(b) at the ends would show.
constexpr double wide_shape = 2.35, narrow_shape = 2.5, windows_digits = 1.9;
constexpr std::size_t filter_terms = 14;  // of f on a panel of width H: interpolation error below 1e-15
constexpr int mesh_sources = 9;           // offsets of a source in a cell of the lattice at which errors are measured
constexpr int mesh_targets = 5;           // offsets of a target
constexpr double mesh_safety = 1.4;       // the largest error is at most so much larger than on that mesh (measured)

/// I_0(x) by its series; all terms are positive.
double bessel_i0(double x) {
  double term = 1, sum = 1;
  for (int n = 1; term > 1e-18 * sum; ++n) {
    term *= (0.5 * x / n) * (0.5 * x / n);
    sum += term;
  }
  return sum;
}

/// Values at the Chebyshev points of [-1, 1] to coefficients of Chebyshev polynomials to those of powers; in that
/// order, because the one matrix for both has large entries of both signs.
class Interpolation {
 public:
  explicit Interpolation(std::size_t terms) : terms_(terms), cosine_(terms * terms), power_(terms * terms, 0.0) {
    for (std::size_t n = 0; n < terms; ++n)
      for (std::size_t i = 0; i < terms; ++i)
        cosine_[n * terms + i] =
            (n == 0 ? 1.0 : 2.0) / static_cast<double>(terms) *
            std::cos(pi * static_cast<double>((n * (2 * i + 1)) % (4 * terms)) / static_cast<double>(2 * terms));
    power_[0] = 1;  // T_0 = 1, T_{n+1} = 2 x T_n - T_{n-1}
    for (std::size_t n = 0; n + 1 < terms; ++n)
      for (std::size_t i = 0; i < terms; ++i)
        power_[(n + 1) * terms + i] =
            (i > 0 ? (n == 0 ? 1 : 2) * power_[n * terms + i - 1] : 0.0) - (n > 0 ? power_[(n - 1) * terms + i] : 0.0);
  }
  void operator()(const double* value, double* power) const {
    std::fill_n(power, terms_, 0.0);
    for (std::size_t n = 0; n < terms_; ++n) {
      double c = 0;
      for (std::size_t i = 0; i < terms_; ++i) c += cosine_[n * terms_ + i] * value[i];
      for (std::size_t i = 0; i <= n; ++i) power[i] += c * power_[n * terms_ + i];
    }
  }

 private:
  std::size_t terms_;
  std::vector<double> cosine_, power_;  // [n][i]
};

double chebyshev_point(std::size_t i, std::size_t terms) {
  return std::cos(pi * (static_cast<double>(i) + 0.5) / static_cast<double>(terms));
}

/// power[a] = factor q^a / sqrt(2^a a!). Returns the largest of the orders 1 .. power.size().
double set_powers(double factor, double q, const std::vector<double>& root, std::vector<double>& power) {
  double largest = 0;
  for (std::size_t a = 0; a < power.size(); ++a) {
    power[a] = factor;
    factor *= q * root[a];
    largest = std::max(largest, std::abs(factor));
  }
  return largest;
}

/// e^{i q t}.
struct Wave {
  double c, s;
};

/// Calls add(a, panel, power[a] cos(q t - a pi/2)) for all orders a at t_0, t_0 + H, ...; e^{i q t} goes from panel to
/// panel by turning.
template <class Add>
void add_waves(Wave at, Wave turn, std::size_t panels, const std::vector<double>& power, const Add& add) {
  for (std::size_t p = 0; p < panels; ++p) {
    for (std::size_t a = 0; a < power.size(); ++a)
      add(a, p, power[a] * (a % 4 == 0 ? at.c : a % 4 == 1 ? at.s : a % 4 == 2 ? -at.c : -at.s));
    at = {at.c * turn.c - at.s * turn.s, at.s * turn.c + at.c * turn.s};
  }
}

/// h~_a(t), a = 0 .. order.
void hermite_functions(int order, double t, double* value) {
  double before = 0;
  value[0] = std::exp(-t * t);
  for (int n = 0; n < order; ++n) {
    const double now = value[n];
    value[n + 1] = std::sqrt(2.0 / (n + 1)) * t * now - std::sqrt(static_cast<double>(n) / (n + 1)) * before;
    before = now;
  }
}

}  // namespace

SpreadWindow SpreadWindow::of(int width, double tolerance) {
  const double shape = width < windows_digits - std::log10(tolerance) ? narrow_shape : wide_shape;
  return {width, shape * width, width + (tolerance < 1e-10 ? 3 : tolerance < 1e-5 ? 2 : 1)};
}

SpreadFilter::SpreadFilter(const SpreadWindow& window, double spacing, int derivative_order, double tolerance,
                           bool grids)
    : width_(window.width),
      degree_(window.degree),
      spacing_(spacing),
      shape_(window.shape),
      top_(bessel_i0(window.shape)),
      tolerance_(tolerance),
      order_(derivative_order),
      grids_(grids) {
  make_window();
  make_filters();
  if (grids_) grid_axis_ = measure_grid();
  point_axis_ = measure_points();
}

void SpreadFilter::make_window() {
  const std::size_t terms = static_cast<std::size_t>(degree_) + 1, w = static_cast<std::size_t>(width_);
  coefficients_.assign(terms * padded_window, 0.0);
  const Interpolation interpolation(terms);
  std::vector<double> value(terms), power(terms);
  for (std::size_t j = 0; j < w; ++j) {
    for (std::size_t i = 0; i < terms; ++i) {
      const double s = static_cast<double>(j) - 0.5 * width_ + 0.5 * (chebyshev_point(i, terms) + 1);
      value[i] = bessel_i0(shape_ * std::sqrt(std::max(0.0, 1 - 4 * s * s / (width_ * width_)))) / top_;
    }
    interpolation(value.data(), power.data());
    for (std::size_t i = 0; i < terms; ++i) coefficients_[i * padded_window + j] = power[i];
  }
}

void SpreadFilter::window_at(double theta, double* values) const {
  for (int j = 0; j < width_; ++j) {
    double sum = 0;
    for (int i = degree_; i >= 0; --i)
      sum = sum * (2 * theta - 1) +
            coefficients_[static_cast<std::size_t>(i) * padded_window + static_cast<std::size_t>(j)];
    values[j] = sum;
  }
}

double SpreadFilter::window(double s) const {
  const double from_left = s + 0.5 * width_;
  if (!(from_left >= 0) || !(from_left < width_)) return 0;
  const double node = std::floor(from_left), x = 2 * (from_left - node) - 1;
  double sum = 0;
  for (int i = degree_; i >= 0; --i)
    sum = sum * x + coefficients_[static_cast<std::size_t>(i) * padded_window + static_cast<std::size_t>(node)];
  return sum;
}

double SpreadFilter::window_transform(double q) const {
  const double squared = shape_ * shape_ - 0.25 * q * q * width_ * width_, root = std::sqrt(std::abs(squared));
  const double value = root < 1e-4 ? 1 + squared / 6 : (squared > 0 ? std::sinh(root) : std::sin(root)) / root;
  return width_ * value / top_;
}

void SpreadFilter::make_filters() {
  const double farthest = 1.3 * std::sqrt(std::log(1 / tolerance_) + 2.0 * order_) + 4 * spacing_ + 2;
  cut_filters(integrate(static_cast<std::size_t>(std::ceil(farthest / spacing_)),
                        pi / (farthest + 0.5 * width_ * spacing_ + 2)));
}

/// The trapezoidal rule is exact to rounding, because the integrands are smooth and the images of f that the rule adds
/// lie outside the range where f is used.
SpreadFilter::Samples SpreadFilter::integrate(std::size_t panels, double step) {
  const double h = spacing_;
  const std::size_t orders = static_cast<std::size_t>(order_) + 1;
  Samples samples{
      panels, std::vector<std::vector<double>>(orders, std::vector<double>(grids_ ? panels * filter_terms : 0, 0.0))};
  lattice_.assign(orders, std::vector<double>(panels, 0.0));
  std::vector<double> root(orders);  // q^{a+1} / sqrt(2^{a+1} (a+1)!) from that of a
  for (std::size_t a = 0; a < orders; ++a) root[a] = 1 / std::sqrt(2.0 * static_cast<double>(a + 1));
  std::vector<double> power(orders);
  for (int n = 0;; ++n) {
    const double q = n * step, gaussian = std::sqrt(pi) * std::exp(-0.25 * q * q);
    double sum = 0;
    for (int m = -3; m <= 3; ++m) {
      const double image = window_transform(q * h + 2 * pi * m);
      sum += image * image;
    }
    const double quotient = window_transform(q * h) / sum;
    const double factor = (n == 0 ? 0.5 : 1.0) * step / pi * gaussian * quotient;
    const Wave turn{std::cos(q * h), std::sin(q * h)};
    const double largest = set_powers(factor, q, root, power);
    for (std::size_t i = 0; grids_ && i < filter_terms; ++i) {
      const double start = q * 0.5 * h * (chebyshev_point(i, filter_terms) + 1);
      add_waves({std::cos(start), std::sin(start)}, turn, panels, power,
                [&](std::size_t a, std::size_t p, double value) { samples.at[a][p * filter_terms + i] += value; });
    }
    set_powers(factor * quotient, q, root, power);
    add_waves({1, 0}, turn, panels, power,
              [&](std::size_t a, std::size_t j, double value) { lattice_[a][j] += value; });
    if (q > 8 && largest < 1e-19) return samples;
  }
}

/// Beyond the reach everything is below `allowed`.
void SpreadFilter::cut_filters(const Samples& samples) {
  const double allowed = 0.15 * tolerance_;
  const std::size_t orders = lattice_.size();
  std::size_t used = 1;
  double last = 0;
  for (std::size_t p = 0; grids_ && p < samples.panels; ++p)
    for (std::size_t i = 0; i < filter_terms; ++i)
      for (std::size_t a = 0; a < orders; ++a)
        if (std::abs(samples.at[a][p * filter_terms + i]) > allowed) {
          used = p + 1;
          last = std::max(last, (static_cast<double>(p) + 0.5 * (chebyshev_point(i, filter_terms) + 1)) * spacing_);
        }
  reach_ = std::min(last + 0.1 * spacing_, static_cast<double>(used) * spacing_);
  std::size_t kept = 1;
  // On a fine lattice many nodes of two windows meet at the border of F.
  const double of_node = grids_ ? allowed : allowed / (window_transform(0) * window_transform(0));
  for (std::size_t j = 0; j < samples.panels; ++j)
    for (std::size_t a = 0; a < orders; ++a)
      if (std::abs(lattice_[a][j]) > of_node) kept = j + 1;
  if (!grids_) {
    for (auto& row : lattice_) row.resize(kept);
    reach_ = static_cast<double>(kept) * spacing_;
    return;
  }
  const Interpolation interpolation(filter_terms);
  filter_.assign(orders, std::vector<double>(used * filter_terms));
  for (std::size_t a = 0; a < orders; ++a) {
    lattice_[a].resize(kept);
    for (std::size_t p = 0; p < used; ++p)
      interpolation(samples.at[a].data() + p * filter_terms, filter_[a].data() + p * filter_terms);
  }
}

double SpreadFilter::filter(int a, double t) const {
  const double distance = std::abs(t);
  if (!(distance <= reach_)) return 0;
  const auto& table = filter_[static_cast<std::size_t>(a)];
  const std::size_t panel = std::min(static_cast<std::size_t>(distance / spacing_), table.size() / filter_terms - 1);
  const double x = 2 * (distance / spacing_ - static_cast<double>(panel)) - 1;
  const double* power = table.data() + panel * filter_terms;
  double sum = 0;
  for (std::size_t i = filter_terms; i-- > 0;) sum = sum * x + power[i];
  return t < 0 && a % 2 == 1 ? -sum : sum;
}

double SpreadFilter::lattice_filter(int a, int j) const {
  const std::size_t distance = static_cast<std::size_t>(std::abs(j));
  const auto& row = lattice_[static_cast<std::size_t>(a)];
  if (distance >= row.size()) return 0;
  return j < 0 && a % 2 == 1 ? -row[distance] : row[distance];
}

/// The error depends on the source's place in its cell and on the distance; targets at or right of the source suffice,
/// since phi is even and f_a has the parity of h~_a.
SpreadFilter::AxisError SpreadFilter::measure_grid() const {
  const std::size_t orders = static_cast<std::size_t>(order_) + 1;
  AxisError axis{std::vector<double>(orders, 0.0), -std::numeric_limits<double>::infinity()};
  const int beyond = static_cast<int>(std::ceil(reach_ / spacing_)) + width_ + 1;
  double window[mesh_sources][padded_window];
  for (int i = 0; i < mesh_sources; ++i) window_at((i + 0.01) / (mesh_sources - 0.98), window[i]);
  std::vector<double> f(static_cast<std::size_t>(2 * beyond + 1)), exact(orders);
  for (int m = 0; m < mesh_targets; ++m) {
    const double offset = (m + 0.37) / mesh_targets;
    for (std::size_t a = 0; a < orders; ++a) {
      for (int k = -beyond; k <= beyond; ++k)
        f[static_cast<std::size_t>(k + beyond)] = filter(static_cast<int>(a), (offset + k) * spacing_);
      for (int i = 0; i < mesh_sources; ++i) {
        const double theta = (i + 0.01) / (mesh_sources - 0.98);  // node j is at j, the source at w/2 - theta
        const double source = 0.5 * width_ - theta;
        for (int k = 0; k + width_ <= 2 * beyond; ++k) {
          // the target is at y = k + w - 1 - beyond + offset, so that node j is k + w - 1 - j in f
          const double t = (k + width_ - 1 - beyond + offset - source) * spacing_;
          if (t < -spacing_) continue;
          double sum = 0;
          for (int j = 0; j < width_; ++j) sum += window[i][j] * f[static_cast<std::size_t>(k + width_ - 1 - j)];
          hermite_functions(static_cast<int>(a), t, exact.data());
          axis.error[a] = std::max(axis.error[a], std::abs(sum - exact[a]));
          if (sum != 0) axis.excess = std::max(axis.excess, std::log(std::abs(sum)) + t * t);
        }
      }
    }
  }
  return axis;
}

SpreadFilter::AxisError SpreadFilter::measure_points() const {
  const std::size_t orders = static_cast<std::size_t>(order_) + 1;
  AxisError axis{std::vector<double>(orders, 0.0), -std::numeric_limits<double>::infinity()};
  double window[mesh_sources][padded_window];
  for (int i = 0; i < mesh_sources; ++i) window_at((i + 0.01) / (mesh_sources - 0.98), window[i]);
  const int beyond = lattice_reach() + width_;
  std::vector<double> column(static_cast<std::size_t>(2 * beyond + 1 + width_));
  const std::size_t places = column.size() - static_cast<std::size_t>(width_) + 1;
  // Only the difference of the offsets counts: exact[(i - o + mesh_sources - 1) places + first][a].
  std::vector<double> exact((2 * mesh_sources - 1) * places * orders);
  const auto distance = [&](std::size_t first, int apart) {
    return (static_cast<double>(first) - beyond + apart / (mesh_sources - 0.98)) * spacing_;
  };
  for (int apart = 1 - mesh_sources; apart < mesh_sources; ++apart)
    for (std::size_t first = 0; first < places; ++first)
      hermite_functions(order_, distance(first, apart),
                        exact.data() + (static_cast<std::size_t>(apart + mesh_sources - 1) * places + first) * orders);
  for (std::size_t a = 0; a < orders; ++a)
    for (int i = 0; i < mesh_sources; ++i) {
      // column[m] = sum_k phi_k F(m - k): the source's share of node m - beyond
      std::fill(column.begin(), column.end(), 0.0);
      for (std::size_t m = 0; m < column.size(); ++m)
        for (int k = 0; k < width_; ++k)
          column[m] += window[i][k] * lattice_filter(static_cast<int>(a), static_cast<int>(m) - beyond - k);
      for (int o = 0; o < mesh_sources; ++o) {
        const double* wanted = exact.data() + static_cast<std::size_t>(i - o + mesh_sources - 1) * places * orders;
        for (std::size_t first = 0; first < places; ++first) {
          const double t = distance(first, i - o);
          if (t < -spacing_) continue;
          double sum = 0;
          for (int j = 0; j < width_; ++j) sum += window[o][j] * column[first + static_cast<std::size_t>(j)];
          axis.error[a] = std::max(axis.error[a], std::abs(sum - wanted[first * orders + a]));
          if (sum != 0) axis.excess = std::max(axis.excess, std::log(std::abs(sum)) + t * t);
        }
      }
    }
  return axis;
}

/// The promise beyond rho^2 = L, tolerance e^{L - rho^2}, allows half for the sum itself: with |sum| <= e^{excess -
/// t^2} on each axis that is d excess <= ln(tolerance/2) + L.
double SpreadFilter::product_error(const AxisError& axis, int d) const {
  const double limit = 2 * std::log(1 / tolerance_) + 40;
  if (d * axis.excess > std::log(0.5 * tolerance_) + limit) return std::numeric_limits<double>::infinity();
  // largest[k] = max over |alpha| <= k of prod (1 + E_a)
  std::vector<double> largest(axis.error.size(), 1.0);
  for (int l = 0; l < d; ++l) {
    std::vector<double> next(largest.size(), 0.0);
    for (std::size_t k = 0; k < largest.size(); ++k)
      for (std::size_t a = 0; a <= k; ++a)
        next[k] = std::max(next[k], (1 + mesh_safety * axis.error[a]) * largest[k - a]);
    largest.swap(next);
  }
  return largest.back() - 1;
}

double expected_spacing(int width, int derivative_order, double tolerance) {
  // where the transform of h~_a falls below the tolerance: q^2/4 = ln(1/tolerance) + a ln q - ln(2^a a!)/2
  const double a = derivative_order;
  double q = 6;
  for (int step = 0; step < 30; ++step)
    q = 2 * std::sqrt(std::max(
                1.0, -std::log(tolerance) + a * std::log(q) - 0.5 * (a * std::numbers::ln2 + std::lgamma(a + 1))));
  const bool narrow = width < windows_digits - std::log10(tolerance);
  return (narrow ? 0.78 : 0.88) * pi / q;
}

namespace {

/// Filters by what they were asked for. All are forgotten when they are too many.
template <class Key>
class Remembered {
 public:
  template <class Make>
  std::shared_ptr<const SpreadFilter> find(const Key& key, const Make& make) {
    constexpr std::size_t most = 256;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (const auto place = known_.find(key); place != known_.end()) return place->second;
    }
    std::shared_ptr<const SpreadFilter> made = make();
    const std::lock_guard<std::mutex> lock(mutex_);
    if (known_.size() >= most) known_.clear();
    return known_.emplace(key, std::move(made)).first->second;
  }

 private:
  std::mutex mutex_;
  std::map<Key, std::shared_ptr<const SpreadFilter>> known_;
};

}  // namespace

std::shared_ptr<const SpreadFilter> find_filter(int d, int width, int derivative_order, double tolerance) {
  static Remembered<std::tuple<int, int, int, double>> remembered;
  return remembered.find({d, width, derivative_order, tolerance}, [&] {
    std::shared_ptr<const SpreadFilter> found;
    const double widest = expected_spacing(width, derivative_order, tolerance);
    for (double spacing = widest; spacing > 0.5 * widest && !found; spacing *= 0.96) {
      auto filter = std::make_shared<const SpreadFilter>(SpreadWindow::of(width, tolerance), spacing, derivative_order,
                                                         tolerance);
      if (std::max(filter->grid_error(d), filter->point_error(d)) <= tolerance) found = std::move(filter);
    }
    return found;
  });
}

std::shared_ptr<const SpreadFilter> lattice_filter(const SpreadWindow& window, double spacing, int derivative_order,
                                                   double tolerance) {
  static Remembered<std::tuple<int, double, int, double, int, double>> remembered;
  return remembered.find({window.width, window.shape, window.degree, spacing, derivative_order, tolerance}, [&] {
    return std::make_shared<const SpreadFilter>(window, spacing, derivative_order, tolerance, false);
  });
}

}  // namespace fgtd::detail
