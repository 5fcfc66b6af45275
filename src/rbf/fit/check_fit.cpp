#include "rbf/fit/check_fit.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "rbf/check.hpp"
#include "rbf/fit/frame.hpp"

namespace rbf::detail {
namespace {

using Index = Eigen::Index;

[[noreturn]] void refuse(const std::string& what) { throw InvalidArgument("rbf: " + what); }

template <int d>
std::string place(const Points<d>& points, Index k) {
  std::string found = "(";
  for (int l = 0; l < d; ++l) found += (l > 0 ? ", " : "") + text(points(l, k));
  return found + ")";
}

template <int d>
void check_distinct(const std::string& kind, const Points<d>& points, const Eigen::Ref<const Eigen::MatrixXd>& values) {
  std::vector<Index> order(static_cast<std::size_t>(points.cols()));
  std::iota(order.begin(), order.end(), Index{0});
  const auto compare = [&](Index a, Index b) {
    for (int l = 0; l < d; ++l)
      if (points(l, a) != points(l, b)) return points(l, a) < points(l, b) ? -1 : 1;
    return 0;
  };
  std::sort(order.begin(), order.end(), [&](Index a, Index b) {
    const int sign = compare(a, b);
    return sign != 0 ? sign < 0 : a < b;
  });
  for (std::size_t i = 1; i < order.size(); ++i) {
    const Index a = order[i - 1], b = order[i];
    if (compare(a, b) != 0) continue;
    refuse(kind + "s " + std::to_string(a) + " and " + std::to_string(b) + " are both at " + place<d>(points, a) +
           (values.row(a) == values.row(b) ? "" : " and have different values") +
           "; remove one, put their mean in place of both, or set FitOptions::regularisation, which allows it");
  }
}

}  // namespace

void check_fit_options(const FitOptions& options) {
  if (!(options.accuracy > 0) || !(options.accuracy < 1))
    refuse("FitOptions::accuracy = " + text(options.accuracy) + ", must lie in (0, 1)");
  if (!(options.regularisation >= 0) || !std::isfinite(options.regularisation))
    refuse("FitOptions::regularisation = " + text(options.regularisation) + ", must be 0 or more, and finite");
  if (options.most_iterations < 1)
    refuse("FitOptions::most_iterations = " + std::to_string(options.most_iterations) + ", must be at least 1");
  if (options.threads < 0)
    refuse("FitOptions::threads = " + std::to_string(options.threads) + ", must be positive, or 0 for all");
  for (const Solver solver : {Solver::automatic, Solver::dense, Solver::krylov})
    if (solver == options.solver) return;
  refuse("FitOptions::solver = " + std::to_string(static_cast<int>(options.solver)) + " is no solver");
}

template <int d>
void check_data(const std::string& kind, const Points<d>& points, const std::string& what,
                const Eigen::Ref<const Eigen::MatrixXd>& values, const FitOptions& options) {
  check_points(kind.c_str(), points.data(), d, static_cast<std::size_t>(points.cols()), d, options.threads);
  if (values.rows() != points.cols())
    refuse("there are " + std::to_string(points.cols()) + " " + kind + "s but " + std::to_string(values.rows()) +
           " rows of " + what + "; every " + kind + " needs one");
  for (Index k = 0; k < values.cols(); ++k)
    for (Index j = 0; j < values.rows(); ++j)
      if (!std::isfinite(values(j, k)))
        refuse(what + ": row " + std::to_string(j) + ", column " + std::to_string(k) + " is " + text(values(j, k)) +
               "; all must be finite");
  if (!(options.regularisation > 0)) check_distinct<d>(kind, points, values);
}

template <int d>
void check_polynomials(const Function& function, const Points<d>& points) {
  const Frame<d> frame(points, positive_order(function.kernel));
  if (frame.size() == 0) return;
  const std::string name = to_string(function.kernel);
  if (points.cols() <= frame.size())
    refuse(std::to_string(points.cols()) + " points are too few for " + name + ", which needs " +
           std::to_string(frame.size() + 1) + " at least; add points, or take inverse-multiquadric or a Matern kernel");
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(frame.values(points));
  qr.setThreshold(1e-8);
  if (qr.rank() < frame.size())
    refuse("all points lie on a " +
           std::string(d == 3   ? "plane"
                       : d == 2 ? "line"
                                : "point") +
           "; " + name + " has a linear polynomial, which they do not determine; take multiquadric or a Matern kernel");
}

template <int d>
void refuse_condition(const FitReport& report, const Points<d>& points, const FitOptions& options,
                      const std::string& what, const char* first) {
  const Function& function = report.function;
  std::string message = "rbf: " + what + " (" + to_string(function.kernel);
  if (takes_shape(function.kernel)) message += " of shape " + text(function.shape);
  message += ", " + std::to_string(report.points) + " points about " + text(report.spacing) + " apart). ";
  if (takes_shape(function.kernel) && !report.shape_was_chosen)
    message += "Lower the shape (begin with that distance), or give 0 to have it chosen; or remove";
  else
    message += takes_shape(function.kernel) ? first : "Remove";
  message += " points that lie very close together, or " + std::string(options.regularisation > 0 ? "raise" : "set") +
             " FitOptions::regularisation";
  if (!(options.regularisation > 0)) {
    const double extent = (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).norm();
    message += " (begin with " + text(1e-9 * largest_value(function, extent)) + ")";
  }
  throw IllConditioned(message);
}

#define GAUSSDRIFT_CHECK_FIT(d)                                                                                \
  template void check_data<d>(const std::string&, const Points<d>&, const std::string&,                        \
                              const Eigen::Ref<const Eigen::MatrixXd>&, const FitOptions&);                    \
  template void check_polynomials<d>(const Function&, const Points<d>&);                                       \
  template void refuse_condition<d>(const FitReport&, const Points<d>&, const FitOptions&, const std::string&, \
                                    const char*);
GAUSSDRIFT_CHECK_FIT(1)
GAUSSDRIFT_CHECK_FIT(2)
GAUSSDRIFT_CHECK_FIT(3)
#undef GAUSSDRIFT_CHECK_FIT

}  // namespace rbf::detail
