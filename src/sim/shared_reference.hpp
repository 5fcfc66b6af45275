// The exact density where several ranks follow its paths together.
#pragma once

#include <memory>

#include "base/communicator.hpp"
#include "gaussdrift/lattice.hpp"
#include "reference/reference.hpp"

namespace gaussdrift {

/// Shares the points of `own` among the ranks, block by block, so that values have the bits of one rank. `own` is that of
/// this rank, made with its share of the blocks. All ranks call each function together; results are on rank 0, and so are
/// the points of evaluate_at().
std::unique_ptr<Reference> shared_reference(std::unique_ptr<Reference> own, const Lattice& lattice,
                                            base::Communicator& ranks);

}  // namespace gaussdrift
