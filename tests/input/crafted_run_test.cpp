// The folder of a run may come from anybody. What is made of it shows text as text, and looks at nothing outside.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "gaussdrift/error.hpp"
#include "read/written_run.hpp"
#include "render/chart_page.hpp"
#include "report/page.hpp"

namespace gaussdrift {
namespace {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

const std::string script = "<script>alert('x')</script>\"><img src=x onerror=\"alert(1)\">\n&lt;\x1b[31m";

/// What a run of two outputs leaves.
json honest_summary() {
  return json::parse(R"({
"case": "s", "title": "t",
"effects": [{"name": "transport", "seconds": 3e-05, "equation": "X'", "changes": ["position"], "conserves": "mass"}],
"particles": {"lattice_points": 441, "carried": 69, "left_out": 3, "threshold": 1e-12, "mass_left_out": 1e-6,
  "charge_left_out": 1e-7, "spacing": 0.1, "core_radius": 0.2, "cutoff": "gauss2"},
"time": {"method": "rk4", "step": 0.1, "end": 0.2, "steps": 2},
"evaluate": {"grid_points": 121, "tolerance": 1e-08, "chosen": "direct"},
"reference": {"kind": "characteristics", "untraced": 1, "trouble": "lost"},
"accuracy": {"target": 1e-3, "achieved": 1e-4, "met": true},
"checks": [{"what": "Linf", "value": 0.4, "t": 0, "max": 0.5, "min": null, "passed": true}],
"warnings": ["careful"],
"threads": 2, "seconds": {"seed": 1e-05, "transport": 3e-05, "total": 0.12},
"frames": [
  {"t": 0, "mass": 0.1, "minimum": 0, "maximum": 0.4, "centroid": [0.3, 0], "outside": 0, "L1": 0.5, "L2": 0.4,
   "Linf": 0.4, "compared": 11, "untraced": 0},
  {"t": 0.2, "mass": 0.1, "minimum": 0, "maximum": 0.4, "centroid": [0.3, 0], "outside": 0.1, "L1": 0.5, "L2": 0.4,
   "Linf": 0.4, "compared": 11, "untraced": 1}],
"worst": {"t": 0.1, "L1": 0.5, "L2": 0.4, "Linf": 0.4},
"budget": {"norm": "largest",
  "predicted": {"time_stepping": 1e-8, "smoothing": 0.4, "transform": 1e-8, "total": 0.4, "dominates": "smoothing"},
  "measured": {"time_stepping": 1e-8, "smoothing": 0.4, "transform": 1e-8, "total": 0.4, "dominates": "smoothing"},
  "advice": ["halve the step"]},
"accuracy_table": [{"tolerance": 0.01, "error": 0.1, "milliseconds": 0.02}], "accuracy_table_note": "note",
"accuracy_table_left_out": "why"})");
}

class CraftedRun : public ::testing::Test {
 protected:
  void SetUp() override {
    const fs::path memory = "/dev/shm";  // many pages are written and made sure of
    folder_ = (access(memory.c_str(), W_OK) == 0 ? memory : fs::temp_directory_path()) /
              ("gaussdrift_crafted_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  static std::string text_of(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  /// The page; empty where the run is refused as damaged or missing.
  std::string page_of(const std::string& summary) const {
    write("summary.json", summary);
    fs::remove(folder_ / "report.html");
    try {
      EXPECT_TRUE(report::write_report(folder_, report::Pictures::not_wanted).failed.empty());
    } catch (const FileError&) {
      return "";
    }
    return text_of(folder_ / "report.html");
  }
  /// But the script of the curves of the error, which is the program's own.
  static void expect_no_markup(std::string page) {
    const std::string own = "<script>\n" + render::chart_script() + "</script>";
    if (const std::size_t at = page.find(own); at != std::string::npos) page.erase(at, own.size());
    for (const char* part : {"<script", "<img src=x", "\x1b"}) EXPECT_EQ(page.find(part), std::string::npos) << page;
  }

  fs::path folder_;
};

/// Calls work() with every value in turn, inner ones too; what it does to one is undone.
void for_every_value(json& value, const std::function<void(json&)>& work) {
  if (value.is_structured())
    for (auto& inner : value) for_every_value(inner, work);
  work(value);
}

TEST_F(CraftedRun, ShowsItsTextAsText) {
  json summary = honest_summary();
  EXPECT_NE(page_of(summary.dump()).find("<h1>t</h1>"), std::string::npos);
  for_every_value(summary, [](json& value) {
    if (value.is_string()) value = script;
  });
  summary["seconds"][script] = 1.0;
  write("run.toml", script);
  write("provenance.json",
        json{{"version", script}, {script, script}, {"data", {{{"file", script}, {"hash", script}}}}}.dump());
  write("summary.png", script);
  const std::string page = page_of(summary.dump());
  EXPECT_NE(page.find("<h1>&lt;script&gt;alert('x')&lt;/script&gt;&quot;&gt;"), std::string::npos);
  expect_no_markup(page);
}

TEST_F(CraftedRun, WithValuesOfOtherTypesIsAPageOrRefused) {
  const json hostile[] = {nullptr,
                          script,
                          1e308,
                          -1e308,
                          -1,
                          std::uint64_t(-1),
                          true,
                          json::array(),
                          json::object(),
                          {{"t", 1}},
                          {script, 1, nullptr}};
  json summary = honest_summary();
  int pages = 0, refused = 0;
  for_every_value(summary, [&](json& value) {
    const json kept = value;
    for (const json& other : hostile) {
      value = other;
      const std::string page = page_of(summary.dump());
      expect_no_markup(page);
      ++(page.empty() ? refused : pages);
    }
    value = kept;
  });
  EXPECT_GT(pages, 500);
  EXPECT_GT(refused, 100);
}

TEST_F(CraftedRun, WithTimesThatAStepCannotTellApartHasAPage) {
  json summary = honest_summary();
  for (const auto& [first, last] : {std::pair{1.0, 1.0000000000000002}, {1e15, 1e15 + 0.125}, {-1e308, 1e308}}) {
    summary["frames"][0]["t"] = first;
    summary["frames"][1]["t"] = last;
    EXPECT_NE(page_of(summary.dump()).find("<svg"), std::string::npos);
  }
}

TEST_F(CraftedRun, ThatIsNestedDeeplyOrNoJsonIsRefused) {
  const std::string text = honest_summary().dump(), deep(1000000, '[');
  for (const std::string& wrong :
       {std::string("{"), std::string("[]"), std::string("\xff"), deep,
        text.substr(0, text.size() - 1) + ",\"more\":" + deep + std::string(1000000, ']') + "}",
        text.substr(0, text.size() - 1) + ",\"more\":1e999}"}) {
    write("summary.json", wrong);
    EXPECT_THROW(report::write_report(folder_, report::Pictures::not_wanted), FileError);
  }
  write("provenance.json", deep + std::string(1000000, ']'));
  EXPECT_NE(page_of(text), "");
}

TEST_F(CraftedRun, DoesNotShowFilesThatItsLinksLeadTo) {
  write("secret", "of the reader");
  fs::create_symlink(folder_ / "secret", folder_ / "run.toml");
  const std::string page = page_of(honest_summary().dump());
  EXPECT_NE(page, "");
  EXPECT_EQ(page.find("of the reader"), std::string::npos);
  fs::remove(folder_ / "summary.json");
  fs::create_symlink("/dev/zero", folder_ / "summary.json");
  EXPECT_THROW(report::write_report(folder_, report::Pictures::not_wanted), FileError);
}

TEST_F(CraftedRun, WhoseSeriesLeadsOutOfItIsRefused) {
  fs::create_directories(folder_ / "density");
  write("density/density_0000.vti",
        "<VTKFile type=\"ImageData\"><ImageData WholeExtent=\"0 1 0 1 0 0\"><Piece Extent=\"0 1 0 1 0 0\"><PointData>"
        "<DataArray type=\"Float64\" Name=\"rho\" format=\"ascii\">1 2 3 "
        "4</DataArray></PointData></Piece></ImageData></VTKFile>");
  const auto series = [&](const std::string& file) {
    write("density.pvd", "<VTKFile type=\"Collection\"><Collection>\n<DataSet timestep=\"7\" file=\"" + file +
                             "\"/></Collection></VTKFile>");
    return read::written_outputs(folder_, "density");
  };
  for (const std::string& inside :
       {std::string("density/density_0000.vti"), std::string("./density/../density/density_0000.vti"),
        (folder_ / "density/density_0000.vti").string()})
    EXPECT_EQ(series(inside).at(0).time, 7) << inside;
  for (const char* outside : {"../density_0000.vti", "density/../../x/density_0000.vti", "/etc/density_0000.vti"}) try {
      series(outside);
      ADD_FAILURE() << outside;
    } catch (const FileError& error) {
      EXPECT_NE(std::string(error.what()).find("line 2 of density.pvd in "), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("which is not in the folder of the run"), std::string::npos);
    }
}

}  // namespace
}  // namespace gaussdrift
