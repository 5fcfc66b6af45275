// The kernel's matrix as an H2 matrix: leaf matrices, transfer matrices, coupling matrices and near blocks, and its
// product with charges.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "farfield/general/bases.hpp"

namespace farfield::detail {

/// The bases of the clusters of one tree.
struct ClusterBases {
  std::vector<std::vector<std::uint32_t>> clusters;  // with a basis, by level
  std::vector<std::size_t> first;                    // by cluster: of its numbers, one for every function
  std::size_t numbers = 0;                           // of all clusters
  std::vector<std::size_t> leaf_first;               // by leaf: of its matrix, points x rank
  Buffer<double> leaf_matrix;
};

class H2Matrix {
 public:
  struct Parts {
    GeneralTree targets;
    GeneralTree sources;  // empty if they are the targets
    bool self;
    GeneralBlocks blocks;
    std::vector<LevelBasis> bases;
  };
  H2Matrix(const KernelData& kernel, int dimension, Parts parts, int threads, std::size_t memory_limit);

  /// charges and sums in the callers' orders; sums are added to.
  void multiply(const double* charges, double* sums, int threads, GeneralSeconds& seconds) const;

  const std::vector<LevelBasis>& bases() const { return parts_.bases; }
  const GeneralBlocks& blocks() const { return parts_.blocks; }
  const ClusterBases& target_bases() const { return target_bases_; }
  std::size_t clusters() const { return parts_.targets.size() + (parts_.self ? 0 : parts_.sources.size()); }
  double basis_bytes() const;
  double coupling_bytes() const;
  double list_bytes() const;

 private:
  /// Couplings whose targets belong to nobody else.
  struct Chunk {
    std::size_t begin, end;  // of its couplings, by matrix
  };
  const GeneralTree& sources() const { return parts_.self ? parts_.targets : parts_.sources; }
  const ClusterBases& source_bases() const { return parts_.self ? target_bases_ : source_bases_; }
  ClusterBases make_bases(GeneralTree& tree, const std::vector<std::uint32_t>& coupled, int threads,
                          std::size_t memory_limit) const;
  void make_chunks();
  Buffer<double> forward(const Buffer<double>& charges, int threads) const;
  void couple(const Buffer<double>& moments, Buffer<double>& coefficients, int threads) const;
  void couple(std::size_t level, const Chunk& chunk, const Buffer<double>& moments, Buffer<double>& coefficients) const;
  void backward(Buffer<double>& coefficients, Buffer<double>& sums, int threads) const;
  void add_near(const Buffer<double>& charges, Buffer<double>& sums, int threads) const;

  const KernelData& kernel_;
  const int dimension_;
  Parts parts_;
  ClusterBases target_bases_, source_bases_;
  std::vector<std::vector<Chunk>> chunks_;               // by level
  std::vector<std::vector<std::vector<double>>> signs_;  // by level and reflection, one for every function
  std::vector<std::vector<std::size_t>> near_targets_;   // by level: where the pairs of a target begin, and the end
};

}  // namespace farfield::detail
