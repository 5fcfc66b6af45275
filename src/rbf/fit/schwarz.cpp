#include "rbf/fit/schwarz.hpp"

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "rbf/fit/kernel_matrix.hpp"
#include "rbf/fit/partition.hpp"

namespace rbf::detail {

using Index = Eigen::Index;

template <int d>
Schwarz<d>::Schwarz(const Function& function, const Points<d>& points, int order, double ridge,
                    const SchwarzParameters& how, int threads, std::size_t memory_limit)
    : function_(function), points_(points), frame_(points, order), threads_(threads) {
  if (points.cols() <= how.dense) {
    dense_.emplace(DenseSystem::of<d>(function, points, frame_, ridge));
    reciprocal_ = dense_->determines_polynomials() ? dense_->reciprocal_condition() : 0;
    return;
  }
  const Partition<d> partition(points_, how.own);
  parts_.resize(partition.size());
  const double around = static_cast<double>(how.around);
  std::vector<double> reciprocal(parts_.size());
  gaussdrift::base::parallel_for(
      {parts_.size(), 3e-10 * around * around * around * static_cast<double>(parts_.size())}, threads,
      [&](std::size_t i) {
        Part& part = parts_[i];
        part.own = partition.part(i);
        part.around = partition.neighbourhood(i, how.around);
        const Points<d> some = chosen<d>(points_, part.around);
        const DenseSystem system = DenseSystem::of<d>(function, some, Frame<d>(some, order), ridge);
        if (!system.determines_polynomials()) return;
        reciprocal[i] = system.reciprocal_condition();
        std::vector<Index> places;
        for (const Index k : part.own)
          places.push_back(std::lower_bound(part.around.begin(), part.around.end(), k) - part.around.begin());
        part.rows = system.weight_rows(places);
        part.diagonal.resize(static_cast<Index>(places.size()));
        for (std::size_t k = 0; k < places.size(); ++k)
          part.diagonal[static_cast<Index>(k)] = part.rows(static_cast<Index>(k), places[k]);
      });
  reciprocal_ = *std::min_element(reciprocal.begin(), reciprocal.end());
  if (!(reciprocal_ > 0)) return;
  if (frame_.size() > 0) {
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(frame_.values(points_));
    polynomials_ = qr.householderQ() * Eigen::MatrixXd::Identity(points.cols(), frame_.size());
  }
  for (std::size_t i = 0; i < partition.size(); ++i)
    for (const Index k : partition.spread(i, how.coarse)) coarse_.push_back(k);
  const Points<d> coarse = chosen<d>(points_, coarse_);
  next_ = std::make_unique<Schwarz>(function, coarse, order, ridge, how, threads, memory_limit);
  reciprocal_ = std::min(reciprocal_, next_->reciprocal_condition());
  sum_ = std::make_unique<Plan<d>>(function, points_, Eigen::VectorXd::Zero(points.cols()),
                                   Options{.tolerance = how.tolerance,
                                           .threads = threads,
                                           .memory_limit = memory_limit,
                                           .expected_targets = coarse_.size()});
}

template <int d>
Schwarz<d>::~Schwarz() = default;

template <int d>
Eigen::VectorXd Schwarz<d>::gathered(const Part& part, const Eigen::VectorXd& values) const {
  Eigen::VectorXd some(static_cast<Index>(part.around.size()));
  for (std::size_t k = 0; k < part.around.size(); ++k) some[static_cast<Index>(k)] = values[part.around[k]];
  return some;
}

template <int d>
Coefficients Schwarz<d>::solve(const Eigen::VectorXd& values) const {
  if (dense_) return dense_->solve(values);
  Eigen::VectorXd weights(values.size());
  gaussdrift::base::parallel_for(
      {parts_.size(), 1e-9 * static_cast<double>(parts_.front().rows.size() * static_cast<Index>(parts_.size()))},
      threads_, [&](std::size_t i) {
        const Eigen::VectorXd own = parts_[i].rows * gathered(parts_[i], values);
        for (std::size_t k = 0; k < parts_[i].own.size(); ++k) weights[parts_[i].own[k]] = own[static_cast<Index>(k)];
      });
  if (frame_.size() > 0) weights -= polynomials_ * (polynomials_.transpose() * weights);
  sum_->set_weights(weights);
  Eigen::VectorXd left = -sum_->evaluate(next_->points_).col(0);
  for (std::size_t k = 0; k < coarse_.size(); ++k) left[static_cast<Index>(k)] += values[coarse_[k]];
  Coefficients coarse = next_->solve(left);
  for (std::size_t k = 0; k < coarse_.size(); ++k) weights[coarse_[k]] += coarse.weights(static_cast<Index>(k), 0);
  if (frame_.size() > 0) {
    // The next level has a frame of its own.
    const double scale = next_->frame_.unit(), unit = frame_.unit();
    if (frame_.size() > 1) {
      coarse.polynomial.bottomRows(d) *= unit / scale;
      coarse.polynomial(0, 0) += coarse.polynomial.col(0).tail(d).dot(frame_.middle() - next_->frame_.middle()) / unit;
    }
  }
  return {std::move(weights), std::move(coarse.polynomial)};
}

template <int d>
Eigen::VectorXd Schwarz<d>::left_out(const Eigen::VectorXd& values) const {
  if (dense_) return dense_->solve(values).weights.col(0).cwiseQuotient(dense_->weight_diagonal());
  Eigen::VectorXd errors(values.size());
  for (const Part& part : parts_) {
    const Eigen::VectorXd own = (part.rows * gathered(part, values)).cwiseQuotient(part.diagonal);
    for (std::size_t k = 0; k < part.own.size(); ++k) errors[part.own[k]] = own[static_cast<Index>(k)];
  }
  return errors;
}

template <int d>
double Schwarz<d>::bytes(Index count, const SchwarzParameters& how) {
  const double dense = static_cast<double>(std::min(count, how.dense));
  return 16 * dense * dense + static_cast<double>(count) * (16.0 * static_cast<double>(how.around) + 100);
}

template class Schwarz<1>;
template class Schwarz<2>;
template class Schwarz<3>;

}  // namespace rbf::detail
