// Every number in a file of a grid is read whole or refused with its line, and nothing is made up where a file has
// gaps.
#include "grid_files.hpp"

namespace gaussdrift::input {
namespace {

class DamagedGrid : public GridFile {
 protected:
  void expect_refusal(const std::string& name, const std::string& part,
                      const read::GridRequest& request = read::GridRequest{}) const {
    const std::string text = refusal(name, request);
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  }
  std::string series_refusal(const std::string& entries) const {
    write_series("series.pvd", entries);
    try {
      read::read_series(folder_ / "series.pvd");
    } catch (const read::GridFileError& error) {
      return error.what() + std::string("\n") + error.remedy();
    }
    return "";
  }
};

TEST_F(DamagedGrid, SeriesHasTimesThatAreNumbers) {
  const auto entry = [](const std::string& time, const std::string& more = "") {
    return "\n<DataSet timestep=\"" + time + "\" file=\"a.vti\"" + more + "/>";
  };
  EXPECT_EQ(series_refusal(entry("0") + entry("+1") + entry(" 1.5 ") + entry("2e0")), "");
  const auto series = read::read_series(folder_ / "series.pvd");
  ASSERT_EQ(series.size(), 4u);
  EXPECT_EQ(series[1].time, 1);
  EXPECT_EQ(series[2].time, 1.5);
  EXPECT_EQ(series[2].line, 4u);
  const struct {
    std::string entries, message;
  } refusals[] = {
      {entry("0,0") + entry("1,5"), "series.pvd:2: timestep = \"0,0\" of a.vti is not a number\nwrite a point"},
      {entry("0") + entry("1,5"), "series.pvd:3: timestep = \"1,5\" of a.vti is not a number"},
      {entry("0") + entry("1.5s"), "timestep = \"1.5s\" of a.vti is not a number"},
      {entry("0") + entry("nan"), "timestep = \"nan\" of a.vti is not a number"},
      {entry("0") + entry(""), "series.pvd:3: a.vti has no timestep"},
      {entry("0") + "\n<DataSet timestep=\"1\"/>", "series.pvd:3: this <DataSet> has no file"},
      {entry("0") + "\n<DataSet file=\"b.vti\"/>", "series.pvd:3: b.vti has no timestep"},
      {entry("0", " part=\"0\"") + entry("0", " part=\"1\""),
       "series.pvd:3: a.vti and a.vti of line 2 are both for t = 0\none file a time is read"},
      {entry("1") + entry("2") + entry("0"), "series.pvd:4: the times of series.pvd do not ascend: 0 after 2"},
      {entry("2") + entry("1") + entry("3"), "series.pvd:4: the times of series.pvd do not descend: 3 after 1"},
  };
  for (const auto& refusal : refusals) {
    const std::string found = series_refusal(refusal.entries);
    EXPECT_NE(found.find(refusal.message), std::string::npos) << refusal.entries << "\n" << found;
  }
}

TEST_F(DamagedGrid, AttributesAreReadWhole) {
  const std::string rho = data(array("rho", 1, "1 2 3 4")), whole = "0 1 0 1 0 0";
  const auto piece = [&](const std::string& extent) { return "<Piece Extent=\"" + extent + "\">" + rho + "</Piece>"; };
  const struct {
    std::string extent, attributes, piece, message;
  } refusals[] = {
      {whole, "Spacing=\"0,1 0,1 1\"", piece(whole), "image.vti:2: Spacing = \"0,1 0,1 1\" is not three numbers"},
      {whole, "Spacing=\"1 1\"", piece(whole), "Spacing = \"1 1\" is not three numbers"},
      {whole, "Spacing=\"1 1 1 1\"", piece(whole), "is not three numbers"},
      {whole, "Spacing=\"1 nan 1\"", piece(whole), "is not three numbers"},
      {whole, "Spacing=\"1 0 1\"", piece(whole), "Spacing is 0 along y"},
      {whole, "Origin=\"0 0x 0\"", piece(whole), "Origin = \"0 0x 0\" is not three numbers"},
      {whole, "Direction=\"1 0 0 0 1 0 0 0\"", piece(whole), "is not nine numbers"},
      {whole, "Direction=\"0 1 0 1 0 0 0 0 1\"", piece(whole), "the image is turned against the axes"},
      {"0 1 0 1 0", "", piece(whole), "WholeExtent = \"0 1 0 1 0\" is not six whole numbers"},
      {"0 1.5 0 1 0 0", "", piece(whole), "is not six whole numbers"},
      {"1 0 0 1 0 0", "", piece(whole), "WholeExtent = \"1 0 0 1 0 0\" has no points along x"},
      {"0 2147483647 0 1 0 0", "", piece(whole), "has an index beyond 1000000000 along x"},
      {"0 100000 0 100000 0 0", "", piece("0 100000 0 100000 0 0"), "1e+10 points; at most"},
      {whole, "", piece("0 1 0 1;0 0"), "image.vti:3: Extent = \"0 1 0 1;0 0\" is not six whole numbers"},
      {whole, "", piece("0 1 0 2 0 0"), "reaches beyond WholeExtent"},
      {whole, "", "<Piece>" + rho + "</Piece>", "this <Piece> has no Extent"},
  };
  for (const auto& refusal : refusals) {
    write_pieces("image.vti", refusal.extent, refusal.attributes, refusal.piece);
    expect_refusal("image.vti", refusal.message);
  }
  for (const char* components : {"-3", "0", "1,5", "two"}) {
    write_image("image.vti", 2, 2,
                "<PointData><DataArray type=\"Float64\" Name=\"rho\" NumberOfComponents=\"" + std::string(components) +
                    "\" format=\"ascii\">1 2 3 4</DataArray></PointData>");
    expect_refusal("image.vti", "NumberOfComponents = \"" + std::string(components) + "\"");
  }
}

TEST_F(DamagedGrid, NumbersInTextAreReadWholeAndAreAsManyAsTheExtentNeeds) {
  for (const auto& [values, word] :
       {std::pair{"1 2 3 4,5", "4,5"}, {"1 2 3,5 4", "3,5"}, {"1 2 3 4e", "4e"}, {"1 2 3 0x4", "0x4"}}) {
    write_image("image.vti", 2, 2, data(array("rho", 1, values)));
    expect_refusal("image.vti", fmt::format("image.vti:3: \"{}\" is not a number: value ", word));
  }
  write_image("image.vti", 2, 2, data(array("rho", 1, "1 2 3 4 5")));
  expect_refusal("image.vti", "image.vti:3: the array \"rho\" has more numbers than the 4 that are needed");
  write_image("image.vti", 2, 2, data(array("rho", 1, "1 2 3")));
  expect_refusal("image.vti", "image.vti:3: the array \"rho\" has fewer numbers than the 4 that are needed");
  for (const auto& [values, type] :
       {std::pair{"1 2 3 4.5", "Int32"}, {"1 2 3 256", "UInt8"}, {"1 2 3 -1", "UInt64"}, {"1 2 3 1e39", "Float32"}}) {
    write_image("image.vti", 2, 2, data(array("rho", 1, values, type)));
    expect_refusal("image.vti", fmt::format("in the array \"rho\" is no number of its type {}", type));
  }
  write_image("image.vti", 2, 2, data(array("rho", 1, "1 2 3 nan")));
  expect_refusal("image.vti", "nan is there");
  write_vtr("grid.vtr", "0 1 2,5", "0 1", data(array("rho", 1, "1 2 3 4 5 6")));
  expect_refusal("grid.vtr", "\"2,5\" is not a number: value 3 of the array \"axis\"");
  // In base64: eight bytes of length, 40 of numbers, where the extent needs four numbers or six.
  const std::string five = "KAAAAAAAAAAAAAAAAADwPwAAAAAAAABAAAAAAAAACEAAAAAAAAAQQAAAAAAAABRA";
  for (const auto& [nx, message] : {std::pair{2, "has more numbers than the 4 that are needed"},
                                    {3, "has fewer numbers than the 6 that are needed"}}) {
    const std::string extent = fmt::format("0 {} 0 1 0 0", nx - 1);
    std::ofstream(folder_ / "binary.vti")
        << "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\"><ImageData "
           "WholeExtent=\""
        << extent << "\"><Piece Extent=\"" << extent
        << "\"><PointData><DataArray type=\"Float64\" Name=\"rho\" format=\"binary\">" << five
        << "</DataArray></PointData></Piece></ImageData></VTKFile>";
    expect_refusal("binary.vti", message);
  }
}

TEST_F(DamagedGrid, PiecesCoverItsExtentWithTheSameArrays) {
  const auto piece = [&](const std::string& extent, const std::string& inside) {
    return "<Piece Extent=\"" + extent + "\">" + inside + "</Piece>\n";
  };
  const auto rho = [&](const std::string& values) { return data(array("rho", 1, values)); };
  const std::string whole = "0 2 0 1 0 0", left = "0 1 0 1 0 0", right = "1 2 0 1 0 0", last = "2 2 0 1 0 0";
  const auto write = [&](const std::string& pieces) { write_pieces("image.vti", whole, "", pieces); };
  write(piece(left, rho("1 2 4 5")) + piece(right, rho("2 3 5 6")));
  EXPECT_EQ(read::read_grid(folder_ / "image.vti", {})->values[0], (std::vector<double>{1, 2, 3, 4, 5, 6}));
  write(piece(left, rho("1 2 4 5")) + piece(last, rho("3 6")));  // all points, but the cells between are nobody's
  EXPECT_EQ(read::read_grid(folder_ / "image.vti", {})->values[0], (std::vector<double>{1, 2, 3, 4, 5, 6}));
  write(piece(left, rho("1 2 4 5")));
  expect_refusal("image.vti", "the pieces of image.vti leave points of its extent without values");
  const auto cells = [&](const std::string& values) { return data(array("rho", 1, values), "CellData"); };
  write(piece(left, cells("1")) + piece(right, cells("2")));
  EXPECT_EQ(read::read_grid(folder_ / "image.vti", {})->values[0].front(), 1);
  write(piece(left, cells("1")) + piece(last, data("", "CellData")));
  expect_refusal("image.vti", "has other arrays than the first one");
  write(piece(left, cells("1")) + piece(last, cells("2")));
  expect_refusal("image.vti", "leave cells of its extent without values");
  write(piece(left, rho("1 2 4 5")) + piece(right, ""));
  expect_refusal("image.vti", "image.vti:4: this piece has other arrays than the first one");
  // VTK takes arrays by their order: u would become v.
  const std::string u = array("u", 1, "1 1 1 1"), v = array("v", 1, "2 2 2 2");
  write(piece(left, data(u + v)) + piece(right, data(v + u)));
  expect_refusal("image.vti", "has other arrays than the first one, or in another order", {.arrays = {"u"}});
  write(piece(left, data(u + u)) + piece(right, data(u + u)));
  expect_refusal("image.vti", "two arrays have the name \"u\"", {.arrays = {"u"}});
}

}  // namespace
}  // namespace gaussdrift::input
