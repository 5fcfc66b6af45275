// provenance.json: the program, machine and data that a run was made with.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "gaussdrift/case.hpp"

namespace gaussdrift::write {

struct DataFile {
  std::string name;            // as it is told
  std::filesystem::path file;  // as it is read
};

/// The text of provenance.json: version, compiler and flags, processor, threads, command line, time, hashes of the case
/// as it was written (FNV-1a, 64 bits) and of every data file (XXH64). "resolved_case" is the hash of all that the result
/// depends on: the resolved case, and the bytes of its data. The time is that of SOURCE_DATE_EPOCH, where that is set.
/// Throws FileError (data that cannot be read), InputError (SOURCE_DATE_EPOCH is no time).
std::string provenance_json(const Case& spec, const std::string& resolved, const std::vector<DataFile>& data,
                            const std::string& command, int threads);

/// "0.9.0".
std::string program_version();

/// "gaussdrift VERSION, COMPILER, PROCESSOR": for the foot of charts and tables of seconds.
std::string made_by();

/// "fnv1a64:..." of a text.
std::string hash_of(const std::string& text);
/// The same of a text and of the bytes of data. A file is read once by a process, unless its size or time changes.
/// Throws FileError.
std::string hash_of(const std::string& text, const std::vector<DataFile>& data);

}  // namespace gaussdrift::write
