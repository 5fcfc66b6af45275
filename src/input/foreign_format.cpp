// Formats are known by their first bytes, not by names of files.
#include "input/foreign_format.hpp"

#include <fmt/format.h>

namespace gaussdrift::input {

namespace {

struct Format {
  std::string_view beginning, name, remedy;
};

constexpr std::string_view netcdf_remedy =
    "with Python: xarray.open_dataset(\"in.nc\").to_dataframe().reset_index().to_csv(\"out.csv\", index=False)";
constexpr std::string_view xml_remedy =
    "a .vtp is read where its name is given, not through a pipe; of others, in ParaView: File, Save Data, CSV";
constexpr std::string_view spreadsheet_remedy = "save the sheet as CSV, with a point as decimal sign";

constexpr Format formats[] = {
    {"CDF\x01", "a NetCDF file", netcdf_remedy},
    {"CDF\x02", "a NetCDF file", netcdf_remedy},
    {"CDF\x05", "a NetCDF file", netcdf_remedy},
    {"\x89HDF", "a NetCDF-4 or HDF5 file",
     "with Python: xarray.open_dataset(\"in.nc\").to_dataframe().reset_index().to_csv(\"out.csv\", index=False), or "
     "numpy.save(\"out.npy\", h5py.File(\"in.h5\")[\"A\"][:])"},
    {"GRIB", "a GRIB file",
     "with Python and cfgrib: xarray.open_dataset(\"in.grib\").to_dataframe().reset_index().to_csv(\"out.csv\", "
     "index=False)"},
    {"PK\x03\x04", "a zip archive, as spreadsheets (.xlsx, .ods) and .npz are",
     "save the sheet as CSV, with a point as decimal sign; of .npz, with Python: numpy.save(\"out.npy\", "
     "numpy.load(\"in.npz\")[\"A\"])"},
    {"\xD0\xCF\x11\xE0", "an old spreadsheet (.xls)", spreadsheet_remedy},
    {"\x1F\x8B", "compressed by gzip", "unpack it with gunzip"},
    {"\xFD"
     "7zXZ",
     "compressed by xz", "unpack it with unxz"},
    {"BZh", "compressed by bzip2", "unpack it with bunzip2"},
    {"\x28\xB5\x2F\xFD", "compressed by zstd", "unpack it with unzstd"},
    {"PAR1", "a Parquet file", "with Python: pandas.read_parquet(\"in\").to_csv(\"out.csv\", index=False)"},
    {"ARROW1", "an Arrow or Feather file", "with Python: pandas.read_feather(\"in\").to_csv(\"out.csv\", index=False)"},
    {"MATLAB 5.0", "a MATLAB file",
     "in MATLAB: writetable(array2table(A, VariableNames=[\"x\" \"y\" ...]), \"out.csv\")"},
    {"# vtk DataFile", "a VTK file", "in ParaView: File, Save Data, CSV"},
    {"<?xml", "an XML file, as those of VTK are", xml_remedy},
    {"<VTKFile", "a VTK file", xml_remedy},
    {"\x89PNG", "a picture", "only numbers in text can be read"},
    {"%PDF", "a PDF document", "only numbers in text can be read"},
    {"{", "JSON", "with Python: pandas.read_json(\"in.json\").to_csv(\"out.csv\", index=False)"},
};

}  // namespace

std::string foreign_format(std::string_view data) {
  for (const Format& format : formats)
    if (data.substr(0, format.beginning.size()) == format.beginning)
      return fmt::format("{}; {}", format.name, format.remedy);
  if (data.substr(0, 2) == "\xFF\xFE" || data.substr(0, 2) == "\xFE\xFF") return "UTF-16; save it as UTF-8";
  constexpr std::size_t looked_at = 4096;
  if (data.substr(0, looked_at).find('\0') != std::string_view::npos)
    return "no text; only numbers in text can be read";
  return "";
}

}  // namespace gaussdrift::input
