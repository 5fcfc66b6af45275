// provenance.json: with what a run was made.
#pragma once

#include <filesystem>
#include <string>

#include "gaussdrift/case.hpp"

namespace gaussdrift::write {

/// Version, compiler and flags, processor, threads, command line, time, and a hash of the case (FNV-1a, 64 bits) and of
/// the resolved case. The time is that of SOURCE_DATE_EPOCH, where that is set. Throws FileError.
void write_provenance(const std::filesystem::path& folder, const Case& scene, const std::string& resolved,
                      const std::string& command, int threads);

/// "fnv1a64:..." of a text.
std::string hash_of(const std::string& text);

}  // namespace gaussdrift::write
