// Flattens combinations of derivatives; see request.hpp.
#include "fgtd/request.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "fgtd/check.hpp"

namespace fgtd::detail {
namespace {

template <int d>
std::string text(const Derivative<d>& alpha) {
  std::string list = "(";
  for (int l = 0; l < d; ++l) list += (l > 0 ? ", " : "") + std::to_string(alpha[static_cast<std::size_t>(l)]);
  return list + ")";
}

}  // namespace

template <int d>
Request<d> make_request(const std::vector<Combination<d>>& combinations, double sigma, int derivative_order) {
  Request<d> request;
  for (std::size_t q = 0; q < combinations.size(); ++q) {
    auto& parts = request.combinations.emplace_back();
    for (const Term<d>& term : combinations[q]) {
      const Derivative<d>& alpha = term.derivative;
      if (std::any_of(alpha.begin(), alpha.end(), [](int a) { return a < 0; })) {
        throw InvalidArgument("fgtd: derivative " + text<d>(alpha) + " has a negative entry");
      }
      const long long order = std::accumulate(alpha.begin(), alpha.end(), 0LL);
      if (order > derivative_order || *std::max_element(alpha.begin(), alpha.end()) > derivative_order) {
        throw InvalidArgument(
            "fgtd: derivative " + text<d>(alpha) + " is of order " + std::to_string(order) +
            ", the plan was made for Options::derivative_order = " + std::to_string(derivative_order));
      }
      if (!std::isfinite(term.coefficient)) {
        throw InvalidArgument("fgtd: coefficient of derivative " + text<d>(alpha) + " is " + text(term.coefficient) +
                              ", must be finite");
      }
      const double factor = term.coefficient * (order % 2 == 0 ? 1.0 : -1.0) * derivative_scale<d>(alpha, sigma);
      if (!std::isfinite(factor)) {
        throw InvalidArgument("fgtd: derivative " + text<d>(alpha) + " of a Gaussian with sigma = " + text(sigma) +
                              " exceeds the range of double");
      }
      auto place = std::find(request.derivatives.begin(), request.derivatives.end(), alpha);
      if (place == request.derivatives.end()) place = request.derivatives.insert(place, alpha);
      parts.push_back({static_cast<std::size_t>(place - request.derivatives.begin()), factor});
      for (std::size_t l = 0; l < d; ++l) request.highest[l] = std::max(request.highest[l], alpha[l]);
    }
  }
  return request;
}

RecurrenceTable::RecurrenceTable(int orders) {
  for (int n = 0; n < orders; ++n) {
    up_.push_back(std::sqrt(2.0 / (n + 1)));
    back_.push_back(std::sqrt(static_cast<double>(n) / (n + 1)));
  }
}

template Request<1> make_request<1>(const std::vector<Combination<1>>&, double, int);
template Request<2> make_request<2>(const std::vector<Combination<2>>&, double, int);
template Request<3> make_request<3>(const std::vector<Combination<3>>&, double, int);
template Request<4> make_request<4>(const std::vector<Combination<4>>&, double, int);

}  // namespace fgtd::detail
