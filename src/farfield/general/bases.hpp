// What all clusters of a level share: polynomials, the functions that recompression leaves of them, how functions of a
// parent are those of its children, and the coupling matrices, one for an offset. Built from the root down, so that the
// functions of a level serve its own couplings and those of all larger clusters.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "farfield/general/clusters.hpp"
#include "farfield/general/polynomials.hpp"

namespace farfield::detail {

struct LevelBasis {
  std::optional<Products> products;  // none: no cluster of this level has a basis
  bool identity = false;             // the functions are the products; else they are the columns of
  RowMatrix functions;               // products x rank; each function has products of one parity
  struct Part {
    Eigen::Index begin, count;          // of its products
    std::vector<Eigen::Index> columns;  // its functions
    RowMatrix functions;                // count x columns.size()
  };
  std::vector<Part> parts;  // of `functions`, by parity
  std::size_t rank = 0;
  std::vector<unsigned> parity;        // of the functions; 0 where nothing is known of the kernel's symmetries
  std::vector<RowMatrix> to_parent;    // by octant, rank x rank of the parent: moments of a child -> of its parent
  std::vector<RowMatrix> from_parent;  // transposed

  struct Matrix {
    RowMatrix transposed;  // size x size: the first functions of source and target
    std::size_t size() const { return static_cast<std::size_t>(transposed.rows()); }
  };
  std::vector<Matrix> matrices;
  struct Use {
    std::uint32_t matrix;
    unsigned reflection;  // bit l: axis l is reversed
  };
  std::vector<Use> uses;  // by offset of the level
};

struct BasisOptions {
  bool recompress = true;
  int fixed_order = 0;  // of all levels; 0: what each level needs
};

/// What is built for a level.
struct LevelTask {
  double side = 1;
  std::vector<GeneralOffset> offsets;
  double allowed = 0;   // root mean square of the error of a pair of points
  bool needed = false;  // some cluster has a basis
};

/// rows (points x products) times the functions.
RowMatrix times_functions(const RowMatrix& rows, const LevelBasis& basis);

/// Throws ToleranceError where the kernel is not smooth enough.
std::vector<LevelBasis> build_bases(const KernelData& kernel, int dimension, const std::vector<LevelTask>& tasks,
                                    const BasisOptions& options, std::size_t memory_limit);

}  // namespace farfield::detail
