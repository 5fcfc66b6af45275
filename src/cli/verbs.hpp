// The verbs of the program: each takes what the command line said and returns an exit code or throws an Error.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "gaussdrift/error.hpp"

namespace gaussdrift::cli {

/// Options that every verb with a case understands.
struct CaseOptions {
  std::filesystem::path file;
  std::vector<std::string> overrides;  // --set key=value
  std::string accuracy{};              // --accuracy, as accuracy.target; empty: as the case says
  int threads = 0;                     // 0: all
  bool json = false;                   // results as JSON on stdout
};

struct RunOptions {
  CaseOptions scene;
  std::filesystem::path folder;  // --out; empty: output/<case name>
  bool force = false;
  std::string command;  // as it was typed, for provenance.json
};

struct StudyVerbOptions {
  CaseOptions scene;
  std::vector<std::string> vary;  // --vary key=a,b,c; none: the standard studies
  int repeats = 3;
  double seconds = 90;
  std::filesystem::path folder;  // --out; empty: output/study_<case name>
  std::filesystem::path csv;     // --csv; empty: the tables in the folder alone
  bool force = false;
};

struct SumOptions {
  std::string kernel = "gauss";
  std::filesystem::path sources, targets;  // targets empty: --grid, or the sources
  std::string columns;                     // "x,y"; empty: all but the weight
  std::string grid;                        // "-1:1:200,-1:1:200"
  std::optional<double> sigma;
  std::vector<std::string> derivatives;  // "0,1,2"; none: the plain sum
  double tolerance = 1e-6;
  std::string method = "auto";
  std::optional<double> seconds;  // most that may be predicted; by default 300 for a method that is named
  std::filesystem::path out;      // empty or "-": standard output
  int threads = 0;                // 0: all
  bool json = false;              // what was chosen as JSON on stdout
};

struct NewOptions {
  std::string name;              // empty: a list
  std::filesystem::path folder;  // --out; empty: here
  bool force = false;
  bool json = false;
};

struct ExplainOptions {
  std::string word;             // empty: all keys
  bool schema = false;          // the JSON schema instead
  std::filesystem::path guide;  // --markdown; docs/cases.md, whose generated parts are written anew
  bool json = false;
};

struct ReportOptions {
  std::filesystem::path folder;
  bool json = false;
};

struct RenderOptions {
  std::filesystem::path folder;
  std::string style;          // empty: the default of the dimension and field
  std::string field = "rho";  // rho, rho_exact, error
  std::vector<double> times;  // empty: all
  std::filesystem::path out;  // empty: images/ of the folder
  bool json = false;
};

struct CompareOptions {
  std::filesystem::path first, second;
  double tolerance = -1;  // negative: none
  bool json = false;
};

struct DoctorOptions {
  bool json = false;
};

ExitCode report(const ReportOptions& options);
ExitCode render(const RenderOptions& options);
ExitCode compare(const CompareOptions& options);
ExitCode doctor(const DoctorOptions& options);
ExitCode new_case(const NewOptions& options);
ExitCode explain(const ExplainOptions& options);
ExitCode run(const RunOptions& options);
ExitCode check(const CaseOptions& options);
ExitCode study(const StudyVerbOptions& options);
struct ReproduceOptions {
  std::string what;              // "cone", "fgtd", "divergence", "figures"; empty: a list
  std::string table;             // of fgtd or divergence, or a figure, as in 4.6; empty: all
  std::filesystem::path folder;  // --out, of figures; empty: output/figures
  bool full = false;             // fgtd, divergence: every row, and no samples of targets; figures: the thesis's steps
  int threads = 0;               // 0: all
  bool json = false;
};
ExitCode reproduce(const ReproduceOptions& options);
ExitCode sum(const SumOptions& options);

/// Parses the command line, does what it says, prints errors on stderr; returns the exit code.
int main_verbs(int argc, char** argv);

}  // namespace gaussdrift::cli
