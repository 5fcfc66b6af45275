// The memory of a run on several ranks, and whether it fits into that of their hosts.
#pragma once

#include "base/communicator.hpp"
#include "gaussdrift/case.hpp"

namespace gaussdrift::accuracy {

/// All ranks together. Throws InputError on all of them if the run is predicted to take more memory than there is: what
/// the ranks of a host take together is compared with its memory, with the control groups that they are in together, and
/// with the bytes that rank 0 has `asked` for (--memory); what a rank takes also with the limits of its process.
void refuse_what_does_not_fit(const Case& spec, int threads, double asked, base::Communicator& ranks);

}  // namespace gaussdrift::accuracy
