// The case that a verb was asked for.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/options.hpp"
#include "gaussdrift/case.hpp"

namespace gaussdrift::cli {

/// Options that every verb with a case understands.
struct CaseOptions {
  std::filesystem::path file;
  std::vector<std::string> overrides{};  // --set key=value
  std::string accuracy{};                // --accuracy, as accuracy.target; empty: as the case says
  int threads = 0;                       // 0: all
  std::string memory{};                  // --memory; empty: no other limit than those that are there
  bool json = false;                     // results as JSON on stdout
};

/// "time.step=", ...: how --set may begin, for shells.
std::vector<std::string> settings_to_begin();

void declare_case(OptionList& options, CaseOptions& given);

/// --memory, for verbs that take much.
void declare_memory(OptionList& options, std::string& value);
/// What it was given, in bytes; infinity where it was not. Throws CommandLineError.
double most_memory(const std::string& value);

/// The file with its overrides. Its warnings are told.
Case read(const CaseOptions& options);

/// The case as it is, or with the settings that its accuracy.target asks for. The choice is told.
Case settled(Case spec, const CaseOptions& options);

}  // namespace gaussdrift::cli
