// Files of a run's folder, which may come from anybody.
#pragma once

#include <filesystem>
#include <string>

namespace gaussdrift::report {

/// The bytes of a file; empty where it is none, or larger than any that a run writes for its page. A link could bring any
/// file of the reader onto the page, and a pipe or a device has no end: they count as none.
std::string read_file_of_run(const std::filesystem::path& file);

}  // namespace gaussdrift::report
