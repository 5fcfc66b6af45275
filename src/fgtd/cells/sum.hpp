// Sums every Gaussian where it is within reach, without an expansion. Sources are sorted into cells whose side is the
// reach or a fraction of it. Method `cells` sums scattered targets, pair by pair with the sources of the cells around.
// Method `outer_product` sums tensor grids, where the Gaussians of a cell are a product of matrices. Both keep their sources
// alike, so each serves both kinds of targets. They differ in the side of the cells.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/buffer.hpp"
#include "fgtd/boxes.hpp"
#include "fgtd/direct/sum.hpp"
#include "fgtd/fgtd.hpp"
#include "fgtd/request.hpp"
#include "fgtd/summation.hpp"

namespace fgtd::detail {

struct MethodEntry;

using gaussdrift::core::Buffer;

/// Cells of one side that start at the lower corner of the sources; occupied ones only, sorted with the last axis
/// slowest.
template <int d>
struct CellLattice {
  double side = 0;
  std::array<double, d> low{};  // lower corner of cell (0, ..., 0)
  int span = 1;                 // sources within reach lie at most this many cells away along an axis
  BoxIndex<d> last{};           // largest index of each axis
  std::vector<BoxIndex<d>> index;
  std::vector<std::size_t> first;       // sources of cell c: first[c] .. first[c+1]
  std::vector<std::size_t> first_line;  // cells that differ in the first axis only: first_line[i] .. first_line[i+1]

  /// Index of the cell of any coordinate; where no source is within reach, an index that says so.
  std::int64_t index_at(std::size_t axis, double x) const;
};

/// How far a Gaussian counts, and the cells that suit.
struct CellsPlan {
  double reach = 0;    // times sqrt(sigma)
  int degree = 0;      // of the exponential of a pair, see fgtd/cells/job.hpp
  int row_degree = 0;  // of the exponentials of rows, of which a term has one an axis
  double side = 0;
  int span = 1;
};

template <int d>
class CellsSum : public Summation<d> {
 public:
  /// position [d][count]
  CellsSum(const CellsPlan& plan, double sigma, Buffer<double> position, std::size_t count, int threads);

  void set_weights(const double* weights, std::size_t columns) override;
  void evaluate(const Request<d>& request, const double* targets, std::size_t count, double* values) const override;
  void evaluate(const Request<d>& request, const TensorGrid& grid,
                double* values) const override;  // fgtd/cells/outer_product.cpp

  double plan_bytes(std::size_t columns) const override;
  double point_bytes(const Request<d>& request, std::size_t count) const override;
  double grid_bytes(const Request<d>& request, const TensorGrid& grid) const override;
  void count(Choice& choice) const override;

 private:
  CellsPlan plan_;
  double sigma_;
  int threads_;
  std::size_t count_;
  std::size_t columns_ = 0;
  std::vector<double> position_;    // [d][count], sorted by cell
  std::vector<double> weights_;     // [columns][count]
  std::vector<std::size_t> order_;  // sorted source j is the caller's order_[j]
  CellLattice<d> cells_;
};

/// The two methods for the catalogue.
MethodEntry cells_method();
MethodEntry outer_product_method();

}  // namespace fgtd::detail
