#include "sim/piece_comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "base/nan.hpp"
#include "reference/sample.hpp"

namespace gaussdrift {

PieceComparison::PieceComparison(const Lattice& lattice, const LatticePieces& pieces, double size)
    : lattice_(lattice), pieces_(pieces) {
  if (size > 0 && std::isfinite(size)) scale_ = std::ldexp(1.0, -std::clamp(std::ilogb(size), -1000, 1000));
  begin();
}

void PieceComparison::begin() {
  sums_.assign(sums, {});
  largest_error_ = 0, largest_ = 0, untraced_ = 0;
}

void PieceComparison::compare(const Reference& reference, double time, const DensityPiece& piece,
                              std::vector<double>& exact) {
  const LatticeBox &box = piece.box, own = pieces_.own(piece.number);
  exact.resize(box.size());
  std::vector<std::size_t> points(box.points[0]);
  std::vector<double> row;
  for (std::size_t l = box.first[2]; l < box.end(2); ++l)
    for (std::size_t j = box.first[1]; j < box.end(1); ++j) {
      for (std::size_t i = 0; i < points.size(); ++i)
        points[i] = box.first[0] + i + lattice_.points[0] * (j + lattice_.points[1] * l);
      reference.evaluate_at(time, points, row);
      const std::size_t first = box.number(box.first[0], j, l);
      std::copy(row.begin(), row.end(), exact.begin() + static_cast<std::ptrdiff_t>(first));
      if (j >= own.end(1) || l >= own.end(2)) continue;
      for (std::size_t i = 0; i < own.points[0]; ++i) {
        if (std::isnan(row[i])) {
          ++untraced_;
          continue;
        }
        const double error = std::abs((*piece.rho)[first + i] - row[i]), size = std::abs(row[i]);
        largest_error_ = std::max(largest_error_, error);
        largest_ = std::max(largest_, size);
        const double e = error * scale_, s = size * scale_, w = part_of_largest_cell(lattice_, points[i]);
        sums_[error_1].add(w * e), sums_[error_2].add(w * (e * e));
        sums_[norm_1].add(w * s), sums_[norm_2].add(w * (s * s));
      }
    }
}

void PieceComparison::tell(base::Communicator& ranks, FrameNumbers& numbers) {
  sum_over_ranks(ranks, sums_);
  ranks.max(std::span(&largest_error_, 1));
  ranks.max(std::span(&largest_, 1));
  ranks.sum(std::span(&untraced_, 1));
  using base::nan;
  numbers.error = ErrorNorms{nan, nan, nan};
  if (largest_ > 0)
    numbers.error = ErrorNorms{sums_[error_1].value() / sums_[norm_1].value(),
                               std::sqrt(sums_[error_2].value() / sums_[norm_2].value()), largest_error_ / largest_};
  numbers.compared = lattice_.size();
  numbers.untraced = static_cast<std::size_t>(untraced_);
}

std::vector<std::size_t> points_of_thinned(const std::vector<std::size_t>& points, const Lattice& thin,
                                           std::size_t every, const Lattice& whole) {
  std::vector<std::size_t> numbers;
  numbers.reserve(points.size());
  for (const std::size_t point : points) {
    const std::size_t i = point % thin.points[0], j = point / thin.points[0] % thin.points[1],
                      l = point / thin.points[0] / thin.points[1];
    numbers.push_back(every * (i + whole.points[0] * (j + whole.points[1] * l)));
  }
  return numbers;
}

std::string words_for_pieces(const LatticePieces& pieces, const Lattice& lattice, const Comparison& compared,
                             bool compares_pieces) {
  const std::size_t every = thinning(lattice);
  const std::string thin = every == 1 ? "all grid points" : fmt::format("every {}. grid point on each axis", every);
  std::string text = fmt::format(
      "the density is written in {} pieces (evaluate.piece_points). Pictures show {}. There is no error budget and no "
      "accuracy table, which need the density as a whole",
      pieces.count(), thin);
  if (compared.points > 0 && !compares_pieces)
    text += fmt::format(". The error is measured at points among these{}",
                        compared.points >= lattice.size() ? ", and not in the files" : "");
  return text;
}

}  // namespace gaussdrift
