#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <mutex>
#include <numbers>

#include "farfield/check.hpp"
#include "farfield/images/lattice_sum.hpp"
#include "farfield/images/rest.hpp"
#include "farfield/interpolation/harmonics.hpp"

namespace farfield::detail {
namespace {

/// A place on the faces of the box of differences, in its corner of positive coordinates, and what is to be there.
struct Sample {
  double t[3] = {};  // scaled
  Smooth wanted;     // without the background; gradient by t
};

/// All places with coordinates reach * nodes[i] on those faces.
template <int d>
std::vector<Sample> on_faces(const double* reach, const std::vector<double>& nodes) {
  std::vector<Sample> samples;
  const std::size_t count = nodes.size(), places = d == 3 ? count * count : count;
  for (std::size_t face = 0; face < d; ++face)
    for (std::size_t i = 0; i < places; ++i) {
      Sample sample;
      sample.t[face] = reach[face];
      sample.t[(face + 1) % d] = reach[(face + 1) % d] * nodes[i % count];
      if (d == 3) sample.t[(face + 2) % d] = reach[(face + 2) % d] * nodes[i / count];
      samples.push_back(sample);
    }
  return samples;
}

/// cos of equal angles from 0 to a right one, at its ends or between them.
std::vector<double> nodes(int count, bool ends) {
  std::vector<double> found;
  for (int i = 0; i < count; ++i)
    found.push_back(std::cos(std::numbers::pi / 2 * (ends ? i / (count - 1.0) : (i + 0.5) / count)));
  return found;
}

/// The functions that are even in every coordinate.
template <int d>
std::vector<std::size_t> even_functions(int degree) {
  std::vector<std::size_t> found;
  for (std::size_t k = 0; k < functions<d>(degree); ++k)
    if (parity<d>(k) == 0) found.push_back(k);
  return found;
}

struct Largest {
  double potential = 0, field = 0;
};

template <int d>
class Fit {
 public:
  Fit(const LatticeSum<d>& sum, const double* reach, double scale) : sum_(sum), reach_(reach), scale_(scale) {}

  /// Least squares on the faces, where a harmonic function is largest.
  std::vector<double> polynomial(int degree) const {
    const std::vector<std::size_t> even = even_functions<d>(degree);
    const std::vector<Sample> samples = wanted_at(nodes(degree / 2 + 2, false));
    Eigen::MatrixXd matrix(static_cast<Eigen::Index>(samples.size()), static_cast<Eigen::Index>(even.size()));
    Eigen::VectorXd right(matrix.rows());
    std::vector<double> harmonics(functions<d>(degree)), coefficients(harmonics.size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      evaluate_harmonics<d>(degree, samples[i].t, harmonics.data());
      for (std::size_t k = 0; k < even.size(); ++k) matrix(row, static_cast<Eigen::Index>(k)) = harmonics[even[k]];
      right[row] = samples[i].wanted.value;
    }
    const Eigen::VectorXd size = matrix.colwise().norm();
    const Eigen::VectorXd solution =
        (matrix * size.cwiseInverse().asDiagonal()).colPivHouseholderQr().solve(right).cwiseQuotient(size);
    for (std::size_t k = 0; k < even.size(); ++k) coefficients[even[k]] = solution[static_cast<Eigen::Index>(k)];
    return coefficients;
  }

  /// The largest error of the potential and of the field, whose components are harmonic too: at places between those of
  /// the fit, at edges and at corners.
  Largest error(int degree, const std::vector<double>& coefficients) const {
    std::vector<double> slopes(d * coefficients.size()), harmonics(coefficients.size());
    double* derivative[3] = {};
    for (std::size_t l = 0; l < d; ++l) derivative[l] = slopes.data() + l * coefficients.size();
    differentiate<d>(degree, coefficients.data(), derivative);
    const auto sum_of = [&](const double* factors) {
      double sum = 0;
      for (std::size_t k = 0; k < harmonics.size(); ++k) sum += factors[k] * harmonics[k];
      return sum;
    };
    Largest largest;
    for (const Sample& sample : wanted_at(nodes(degree / 2 + 5, true))) {
      evaluate_harmonics<d>(degree, sample.t, harmonics.data());
      double squared = 0;
      for (std::size_t l = 0; l < d; ++l) squared += std::pow(sum_of(derivative[l]) - sample.wanted.gradient[l], 2);
      largest.potential = std::max(largest.potential, std::abs(sum_of(coefficients.data()) - sample.wanted.value));
      largest.field = std::max(largest.field, std::sqrt(squared) * scale_);
    }
    return largest;
  }

 private:
  std::vector<Sample> wanted_at(const std::vector<double>& nodes) const {
    std::vector<Sample> samples = on_faces<d>(reach_, nodes);
    for (Sample& sample : samples) {
      double z[3] = {}, squared = 0;
      for (std::size_t l = 0; l < d; ++l) {
        z[l] = sample.t[l] / scale_;
        squared += z[l] * z[l];
      }
      sample.wanted = sum_.at(z);
      sample.wanted.value -= sum_.laplacian() / (2 * d) * squared;
      for (std::size_t l = 0; l < d; ++l)
        sample.wanted.gradient[l] = (sample.wanted.gradient[l] - sum_.laplacian() / d * z[l]) / scale_;
    }
    return samples;
  }

  const LatticeSum<d>& sum_;
  const double* reach_;
  double scale_;
};

/// What the promise is relative to, at least, for a charge and its near images. At a difference z the images at c and at -c
/// have distances a, b with a^2 + b^2 = 2 (z^2 + c^2), and any falling power of a^2 is convex.
template <int d>
Largest least_sums(const Copies<d>& copies) {
  double farthest = 0;
  for (const CopiedAxis& axis : copies.axes()) farthest += axis.reach() * axis.reach();
  Largest sums;
  for (const Copy& copy : copies.near()) {
    double squared = farthest;
    for (const double shift : copy.shift) squared += shift * shift;
    sums.field += d == 3 ? 1 / squared : 1 / std::sqrt(squared);
    sums.potential += d == 3 ? 1 / std::sqrt(squared) : 1;
  }
  return sums;
}

constexpr int highest_degree = 64;  // where rounding begins to show

}  // namespace

template <int d>
RestShape<d>::RestShape(const Copies<d>& copies, double tolerable)
    : axes_(copies.axes()), charge_(copies.turned().back().charge), tolerable_(tolerable) {
  double longest = 0;
  for (const CopiedAxis& axis : axes_) longest = std::max(longest, axis.reach());
  const Largest unit = least_sums<d>(copies);
  scale_ = stretch / 2 / longest;
  double reach[3] = {};
  for (std::size_t l = 0; l < d; ++l) reach[l] = axes_[l].reach() * scale_;

  std::vector<LatticeSum<d>> sums;
  for (const Copy& copy : copies.turned()) sums.emplace_back(axes_, copy);
  laplacian_ = sums.front().laplacian();
  const auto fit_all = [&] {
    polynomials_.clear();
    error_ = 0;
    for (const LatticeSum<d>& sum : sums) {
      const Fit<d> fit(sum, reach, scale_);
      polynomials_.push_back(fit.polynomial(degree_));
      const Largest error = fit.error(degree_, polynomials_.back());
      error_ += std::max(error.potential / unit.potential, error.field / unit.field);
    }
  };
  // Two low degrees tell how fast the error falls with the degree.
  double last = 0;
  for (degree_ = 6; degree_ <= highest_degree;) {
    fit_all();
    if (error_ <= tolerable) return;
    int more = 2;
    if (degree_ == 6) {
      last = error_;
      more = 6;
    } else if (degree_ == 12 && error_ < last) {
      const double needed = std::log(error_ / tolerable) / (std::log(last / error_) / 6);
      more = std::clamp(2 * static_cast<int>(0.4 * needed), 2, highest_degree - degree_);
    }
    degree_ += more;
  }
  throw ToleranceError("farfield: the copies of a box that are far away can be summed to " + text(error_) +
                       " of the sum of all single fields here, which is more than the " + text(tolerable) +
                       " that Options::tolerance allows them");
}

template <int d>
bool RestShape<d>::fits(const std::array<CopiedAxis, 3>& axes, double charge, double tolerable) const {
  for (std::size_t l = 0; l < d; ++l) {
    CopiedAxis one = axes[l], other = axes_[l];
    one.centre = other.centre = 0;
    if (!(one == other)) return false;
  }
  return charge == charge_ && tolerable == tolerable_;
}

template <int d>
std::shared_ptr<const RestShape<d>> RestShape<d>::get(const Copies<d>& copies, double tolerable) {
  static std::mutex mutex;
  static std::weak_ptr<const RestShape> last;
  const std::lock_guard lock(mutex);
  std::shared_ptr<const RestShape> shape = last.lock();
  if (!shape || !shape->fits(copies.axes(), copies.turned().back().charge, tolerable)) {
    shape = std::make_shared<const RestShape>(copies, tolerable);
    last = shape;
  }
  return shape;
}

template class RestShape<2>;
template class RestShape<3>;

}  // namespace farfield::detail
