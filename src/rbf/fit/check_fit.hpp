// Refuses what cannot be fitted, with a remedy.
#pragma once

#include <string>

#include "rbf/interpolant.hpp"

namespace rbf::detail {

void check_fit_options(const FitOptions& options);

/// Points are finite, and distinct unless there is regularisation; there is a row of finite values for each. `kind` and
/// `what` are what the message calls a point, and the values.
template <int d>
void check_data(const std::string& kind, const Points<d>& points, const std::string& what,
                const Eigen::Ref<const Eigen::MatrixXd>& values, const FitOptions& options);

/// The points determine the kernel's polynomial.
template <int d>
void check_polynomials(const Function& function, const Points<d>& points);

/// Throws IllConditioned: `what`, for which kernel and points, and what helps. `first` is what the advice begins with if
/// the shape was chosen.
template <int d>
[[noreturn]] void refuse_condition(const FitReport& report, const Points<d>& points, const FitOptions& options,
                                   const std::string& what, const char* first = "Take thin-plate, remove");

}  // namespace rbf::detail
