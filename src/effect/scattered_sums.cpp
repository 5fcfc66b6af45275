#include "effect/scattered_sums.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include "base/users_words.hpp"
#include "gaussdrift/error.hpp"
#include "particle/images.hpp"
#include "particle/placing.hpp"

namespace gaussdrift {

namespace {

constexpr double nothing = 1e-14;  // of a Gaussian: what is farther is not felt

// exp(-r^2 / width^2) = nothing.
double reach_of(double width) { return width * std::sqrt(-std::log(nothing)); }

Tiles tiles_of(const Particles& particles, const Lattice& lattice, double width, const TileLimits& limits,
               base::Communicator& ranks) {
  return {lattice, reach_of(width), particles.view(), limits,
          [&](std::vector<std::int64_t>& counts) { ranks.sum(counts); }};
}

Eigen::MatrixXd rows_of(const Eigen::MatrixXd& all, const std::vector<std::size_t>& chosen) {
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(chosen.size()), all.cols());
  for (Eigen::Index i = 0; i < rows.rows(); ++i)
    rows.row(i) = all.row(static_cast<Eigen::Index>(chosen[static_cast<std::size_t>(i)]));
  return rows;
}

void set_rows(Eigen::MatrixXd& all, const std::vector<std::size_t>& chosen, const Eigen::MatrixXd& rows) {
  for (Eigen::Index i = 0; i < rows.rows(); ++i)
    all.row(static_cast<Eigen::Index>(chosen[static_cast<std::size_t>(i)])) = rows.row(i);
}

base::Bytes bytes_of(const Eigen::MatrixXd& rows) {
  return base::to_bytes(std::span<const double>(rows.data(), static_cast<std::size_t>(rows.size())));
}

Eigen::MatrixXd matrix_of(const base::Bytes& bytes, Eigen::Index columns) {
  const std::vector<double> values = base::from_bytes<double>(bytes);
  return Eigen::Map<const Eigen::MatrixXd>(values.data(), static_cast<Eigen::Index>(values.size()) / columns, columns);
}

}  // namespace

template <int d>
ScatteredSums<d>::ScatteredSums(std::string what, const Particles& particles, const Lattice& lattice, double width,
                                const TileLimits& limits, const fgtd::Options& options, base::Communicator& ranks,
                                const Folding& folding)
    : what_(std::move(what)),
      ranks_(ranks),
      width_(width),
      options_(options),
      count_(particles.size()),
      images_(folding.folds() ? with_images(particles, folding, reach_of(width), &of_) : Particles()),
      all_(folding.folds() ? &images_ : &particles),
      tiles_(tiles_of(*all_, lattice, width, limits, ranks)),
      here_(all_) {
  std::vector<double> work;
  for (const Tile& tile : tiles_.list()) work.push_back(static_cast<double>(tile.particles) + tile.sources);
  const std::vector<int> owner =
      work.size() == 1 ? std::vector<int>{0} : share_tiles(work, ranks_.size());  // one: rank 0 has all of them
  if (ranks_.size() > 1) send(owner);
  ranks_.agree_on([&] {
    std::vector<std::size_t> order(here_->size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    if (ranks_.size() > 1)
      std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return here_->id[a] < here_->id[b]; });
    std::vector<TileOfSum> all(work.size());
    const PointsView x = here_->view();
    const auto is_own = [&](std::size_t tile) { return owner[tile] == ranks_.rank(); };
    for (const std::size_t j : order) {
      const Vector place = x.at(j);
      tiles_.near(place, [&](std::size_t tile) {
        if (is_own(tile)) all[tile].sources.push_back(j);
      });
      if (is_image(here_->id[j])) continue;
      if (const std::size_t tile = tiles_.of(place); is_own(tile)) all[tile].targets.push_back(j);
    }
    for (TileOfSum& tile : all)
      if (!tile.targets.empty()) own_.push_back(std::move(tile));
  });
}

// Every particle to the ranks whose tiles feel it. One of them has the tile that it lies in, and sums there.
template <int d>
void ScatteredSums<d>::send(const std::vector<int>& owner) {
  const auto ranks = static_cast<std::size_t>(ranks_.size());
  std::vector<base::Bytes> out(ranks);
  ranks_.agree_on([&] {
    sent_.resize(ranks), summed_by_.resize(ranks);
    const PointsView x = all_->view();
    for (std::size_t j = 0; j < all_->size(); ++j) {
      const Vector place = x.at(j);
      tiles_.near(place, [&](std::size_t tile) {
        auto& list = sent_[static_cast<std::size_t>(owner[tile])];
        if (list.empty() || list.back() != j) list.push_back(j);
      });
      if (j < count_) summed_by_[static_cast<std::size_t>(owner[tiles_.of(place)])].push_back(j);
    }
    for (std::size_t r = 0; r < ranks; ++r) out[r] = pack_bare(*all_, sent_[r]);
  });
  std::vector<base::Bytes> in = ranks_.exchange(std::move(out));
  ranks_.agree_on([&] {
    came_.resize(ranks), sums_for_.resize(ranks);
    arrived_.dimension = all_->dimension;
    for (std::size_t r = 0; r < ranks; ++r) {
      const std::size_t before = arrived_.size();
      unpack(in[r], arrived_);
      in[r] = {};
      for (std::size_t j = before; j < arrived_.size(); ++j) {
        came_[r].push_back(j);
        if (!is_image(arrived_.id[j]) && owner[tiles_.of(arrived_.view().at(j))] == ranks_.rank())
          sums_for_[r].push_back(j);
      }
    }
  });
  here_ = &arrived_;
}

template <int d>
Eigen::MatrixXd ScatteredSums<d>::to_owners(const Eigen::MatrixXd& weights) const {
  std::vector<base::Bytes> out;
  for (const auto& list : sent_) out.push_back(bytes_of(rows_of(weights, list)));
  const std::vector<base::Bytes> in = ranks_.exchange(std::move(out));
  Eigen::MatrixXd all(static_cast<Eigen::Index>(here_->size()), weights.cols());
  for (std::size_t r = 0; r < in.size(); ++r) set_rows(all, came_[r], matrix_of(in[r], weights.cols()));
  return all;
}

template <int d>
Eigen::MatrixXd ScatteredSums<d>::from_owners(const Eigen::MatrixXd& sums, std::size_t particles) const {
  std::vector<base::Bytes> out;
  for (const auto& list : sums_for_) out.push_back(bytes_of(rows_of(sums, list)));
  const std::vector<base::Bytes> in = ranks_.exchange(std::move(out));
  Eigen::MatrixXd own(static_cast<Eigen::Index>(particles), sums.cols());
  for (std::size_t r = 0; r < in.size(); ++r) set_rows(own, summed_by_[r], matrix_of(in[r], sums.cols()));
  return own;
}

template <int d>
fgtd::Points<d> ScatteredSums<d>::points(const std::vector<std::size_t>& chosen) const {
  fgtd::Points<d> places(d, static_cast<Eigen::Index>(chosen.size()));
  for (int k = 0; k < d; ++k)
    for (std::size_t i = 0; i < chosen.size(); ++i)
      places(k, static_cast<Eigen::Index>(i)) = here_->position[k][chosen[i]];
  return places;
}

template <int d>
Eigen::MatrixXd ScatteredSums<d>::of(const Eigen::MatrixXd& weights) {
  const bool several = ranks_.size() > 1;
  Eigen::MatrixXd theirs;  // of images, and of what came from other ranks
  if (!of_.empty()) theirs = rows_of(weights, of_);
  if (several) theirs = to_owners(of_.empty() ? weights : theirs);
  const Eigen::MatrixXd& all = several || !of_.empty() ? theirs : weights;
  Eigen::MatrixXd sums(all.rows(), all.cols());
  ranks_.agree_on([&] {
    try {
      for (TileOfSum& tile : own_) {
        const Eigen::MatrixXd of_tile = rows_of(all, tile.sources);
        if (tile.plan)
          tile.plan->set_weights(of_tile);
        else
          tile.plan.emplace(points(tile.sources), of_tile, 1 / (width_ * width_), options_);
        set_rows(sums, tile.targets, tile.plan->evaluate(points(tile.targets)));
      }
    } catch (const fgtd::Error& error) {
      throw NumericalError(what_ + " cannot be summed: " +
                           base::in_users_words(error.what(), {{"Options::tolerance = ", "a tolerance of "}}));
    }
  });
  if (several) return from_owners(sums, count_);
  sums.conservativeResize(static_cast<Eigen::Index>(count_), Eigen::NoChange);  // those of images come last
  return sums;
}

template class ScatteredSums<2>;
template class ScatteredSums<3>;

}  // namespace gaussdrift
