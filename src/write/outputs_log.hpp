// The numbers of the outputs of a run, in a file beside its checkpoints that only grows: bytes written grow with the
// outputs, not with their square. A checkpoint tells how much of the file counts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "write/part_file.hpp"

namespace gaussdrift::write {

/// What the file says up to a place.
struct OutputsMark {
  std::uint64_t bytes = 0, crc32 = 0;
  std::vector<std::string> outputs{};  // of the last rows, by their numbers
};

std::filesystem::path outputs_log(const std::filesystem::path& folder);

/// Puts behind the mark what the file does not say yet, and moves the mark. What stood behind it, of a process that was
/// killed or of a checkpoint that is not used, goes. Throws std::system_error; the mark is as before then.
void append_outputs(const std::filesystem::path& folder, const std::vector<std::string>& outputs, OutputsMark& mark,
                    const InHaste& in_haste);

/// Throws std::runtime_error with the reason if the file does not say that.
OutputsMark read_outputs(const std::filesystem::path& folder, std::uint64_t bytes, std::uint64_t crc32);

}  // namespace gaussdrift::write
