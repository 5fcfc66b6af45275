#include "effect/remesh_kernel.hpp"

#include <Eigen/LU>
#include <cmath>
#include <utility>

namespace gaussdrift {

namespace {

double factorial(int n) { return std::tgamma(n + 1.0); }

// c[m][i]: weights of the central differences of f^(m)(0) at the nodes -p/2 .. p/2, exact for degree p:
// sum_i c_i x_i^k = k! [k = m].
std::vector<std::vector<double>> central_differences(int p, int highest) {
  Eigen::MatrixXd powers(p + 1, p + 1);
  for (int k = 0; k <= p; ++k)
    for (int i = 0; i <= p; ++i) powers(k, i) = k == 0 ? 1 : std::pow(i - p / 2, k);
  const Eigen::FullPivLU<Eigen::MatrixXd> solver(powers);
  std::vector<std::vector<double>> stencils;
  for (int m = 0; m <= highest; ++m) {
    const Eigen::VectorXd c = solver.solve(factorial(m) * Eigen::VectorXd::Unit(p + 1, m));
    stencils.emplace_back(c.data(), c.data() + c.size());
  }
  return stencils;
}

// The polynomial of degree 2r + 1 with the derivatives 0 .. r at 0 and at 1 given.
std::vector<double> two_point_hermite(const std::vector<double>& at_0, const std::vector<double>& at_1) {
  const int r = static_cast<int>(at_0.size()) - 1, degree = 2 * r + 1;
  const auto falling = [](int k, int m) { return k < m ? 0.0 : factorial(k) / factorial(k - m); };
  std::vector<double> a(static_cast<std::size_t>(degree) + 1);
  for (int m = 0; m <= r; ++m) a[static_cast<std::size_t>(m)] = at_0[static_cast<std::size_t>(m)] / factorial(m);
  Eigen::MatrixXd matrix(r + 1, r + 1);
  Eigen::VectorXd right(r + 1);
  for (int m = 0; m <= r; ++m) {
    right(m) = at_1[static_cast<std::size_t>(m)];
    for (int k = 0; k <= r; ++k) right(m) -= falling(k, m) * a[static_cast<std::size_t>(k)];
    for (int k = 0; k <= r; ++k) matrix(m, k) = falling(r + 1 + k, m);
  }
  const Eigen::VectorXd upper = matrix.fullPivLu().solve(right);
  for (int k = 0; k <= r; ++k) a[static_cast<std::size_t>(r + 1 + k)] = upper(k);
  return a;
}

// The Gaussian of order 8 and width 2, convolved with the heat kernel exp(-x^2/spread):
// (sqrt(pi) w)^-1 sum_{j<4} (-1)^j (2/w)^{2j} / (4^j j!) H_{2j}(x/w) exp(-x^2/w^2), w^2 = 4 + spread, which is
// method.md, equation (4), in one dimension. On the nodes it is right to 1e-13, the aliasing exp(-(2 pi)^2) times
// powers; what is cut off is below 1e-12. The sum is made 1, so that the mass is right to rounding.
void smooth_weights(double place, double spread, std::int64_t& first, std::vector<double>& weights) {
  constexpr double core = 2;
  const double w = std::sqrt(core * core + spread), ratio = core * core / (w * w);
  const double below = std::floor(place), fraction = place - below;
  const auto half = static_cast<std::int64_t>(std::ceil(6 * w));
  first = static_cast<std::int64_t>(below) - half;
  weights.resize(static_cast<std::size_t>(2 * half + 2));
  double sum = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double t = (static_cast<double>(i) - static_cast<double>(half) - fraction) / w, s = t * t;
    const double h2 = 4 * s - 2, h4 = (16 * s - 48) * s + 12, h6 = ((64 * s - 480) * s + 720) * s - 120;
    const double series = 1 - ratio * (h2 / 4 - ratio * (h4 / 32 - ratio * h6 / 384));
    sum += weights[i] = series * std::exp(-s);
  }
  for (double& weight : weights) weight /= sum;
}

// Lambda_{p,r}, piecewise of degree 2r + 1 and r times differentiable, keeps moments up to p. Sum_i f_i Lambda(x - i)
// interpolates f. Its derivatives at a node are the central differences there, so that it is a two-point Hermite
// interpolant on every cell. Such a one reproduces any polynomial whose derivatives 0 .. r at both ends it is given,
// and for degrees <= p the differences are those.
class Piecewise {
 public:
  Piecewise(int p, int r) : p_(p) {
    const auto stencils = central_differences(p, r);
    for (int node = 0; node < p + 2; ++node) {
      std::vector<double> at_0, at_1;
      for (int m = 0; m <= r; ++m) {
        const auto& c = stencils[static_cast<std::size_t>(m)];
        at_0.push_back(node <= p ? c[static_cast<std::size_t>(node)] : 0.0);
        at_1.push_back(node >= 1 ? c[static_cast<std::size_t>(node - 1)] : 0.0);
      }
      polynomials_.push_back(two_point_hermite(at_0, at_1));
    }
  }

  void operator()(double place, double spread, std::int64_t& first, std::vector<double>& weights) const {
    if (spread > 0) return smooth_weights(place, spread, first, weights);
    const double below = std::floor(place), t = place - below;
    first = static_cast<std::int64_t>(below) - p_ / 2;
    weights.resize(polynomials_.size());
    // The kernel is even; small arguments keep the polynomials' rounding small.
    const bool mirrored = t > 0.5;
    const double argument = mirrored ? 1 - t : t;
    for (std::size_t node = 0; node < polynomials_.size(); ++node) {
      const std::vector<double>& a = polynomials_[node];
      double value = 0;
      for (auto c = a.rbegin(); c != a.rend(); ++c) value = value * argument + *c;
      weights[mirrored ? polynomials_.size() - 1 - node : node] = value;
    }
  }

 private:
  int p_;
  std::vector<std::vector<double>> polynomials_;  // one a node, lowest power first
};

RemeshKernel piecewise(std::string_view name, int p, int r, std::string_view meaning) {
  return {.name = name, .meaning = meaning, .moments = p, .takes_spread = 2.25, .share = Piecewise(p, r)};
}

}  // namespace

const std::vector<RemeshKernel>& remesh_kernels() { return base::catalogue<RemeshKernel>(); }

const RemeshKernel& find_remesh_kernel(std::string_view name) {
  return base::find_named(remesh_kernels(), "remeshing kernel", name);
}

}  // namespace gaussdrift

namespace gaussdrift::base {

template <>
std::vector<RemeshKernel>& catalogue() {
  static std::vector<RemeshKernel> all{
      // Smooth, so that it also sums up particles that no longer stand on a lattice, as long as they overlap.
      {.name = "gauss8",
       .meaning = "is smooth, keeps moments up to order 7 and tolerates a stretch of 1.5",
       .moments = 7,
       .share = smooth_weights},
      // A quarter of the nodes an axis, for particles that have hardly moved against each other.
      piecewise(
          "lambda44", 4, 4,
          "is piecewise polynomial and keeps moments up to order 4. It is cheaper but wants a stretch of at most 1.1"),
      piecewise("lambda66", 6, 6, "is the same with moments up to order 6"),
      piecewise("m4prime", 2, 1, "is the same with moments up to order 2"),  // Monaghan's M4' [CEPP14]
  };
  return all;
}

}  // namespace gaussdrift::base
