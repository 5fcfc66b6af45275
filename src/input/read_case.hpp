// From a case file to a Case: parse, override, validate; and back.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "gaussdrift/case.hpp"

namespace gaussdrift::input {

/// Several complaints about one case file, already laid out for people (place, line, caret, rule, remedy).
class CaseError : public InputError {
 public:
  CaseError(const std::string& text, int count) : InputError(text), count_(count) {}
  int count() const { return count_; }

 private:
  int count_;
};

struct ReadResult {
  Case scene;
  std::vector<std::string> warnings;  // laid out like the errors: unused parameters, small overlap, ...
};

/// Reads and validates. `overrides` are "key=value" with dotted keys as in --set; values have the types of the file.
/// Throws FileError (the file cannot be read) or CaseError with all errors of the file in one pass. Tables and data
/// that the case names are read as well, and fields fitted to samples on `threads` threads (0: all).
ReadResult read_case(const std::filesystem::path& file, const std::vector<std::string>& overrides = {},
                     int threads = 0);

/// The same from a text; `file` names it in messages.
ReadResult parse_case(const std::string& text, const std::filesystem::path& file,
                      const std::vector<std::string>& overrides = {}, int threads = 0);

/// The resolved case as a case file: defaults and overrides spelt out; reading it gives the same Case, but for
/// parameters that only stood in numbers, which are written as values. Data files are named by their absolute paths, or
/// as seen from `folder`, where the text is to lie.
std::string resolved_toml(const Case& scene, const std::filesystem::path& folder = {});

/// Grids and tables that the case reads, in its order; those that a .pvd lists follow it.
std::vector<std::filesystem::path> data_files(const Case& scene);

/// The case with the names of its data files without their folders; its text then is the same wherever they lie.
Case with_bare_names(Case scene);

/// `file` as seen from `folder`: relative, whatever links lead there; absolute where that cannot be.
std::filesystem::path seen_from(const std::filesystem::path& folder, const std::filesystem::path& file);

}  // namespace gaussdrift::input
