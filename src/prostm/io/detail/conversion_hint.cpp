#include "prostm/io/detail/conversion_hint.hpp"

#include <algorithm>
#include <array>

namespace prostm {
namespace {

struct Conversion {
  std::array<std::string_view, 5> endings;  // unused entries are empty
  std::string_view hint;
};

// A field's row 0 has the smallest y, and its column 0 the smallest x.
constexpr std::array<Conversion, 10> kConversions = {{
    {{".vtk", ".vti", ".vtr", ".vts", ".vtu"},
     "convert it with Python: m = pyvista.read(FILE); numpy.save(\"field.npy\", "
     "m[NAME].reshape(m.dimensions[::-1])[k]), since VTK counts x fastest: axes are z, y, x"},
    {{".vdb"},
     "convert it with Python: copy the grid to an array a[x, y, z] with openvdb's copyToArray, "
     "then numpy.save(\"field.npy\", a[:, :, k].T)"},
    {{".mat"},
     "convert it with Python: numpy.save(\"field.npy\", scipy.io.loadmat(FILE)[NAME]) for axes "
     "y, x as of meshgrid, with .T for x, y as of ndgrid; files of version 7.3 are HDF5: "
     "h5py.File(FILE)[NAME][()].T"},
    {{".tif", ".tiff", ".exr"},
     "convert it with Python: numpy.save(\"field.npy\", imageio.v3.imread(FILE)[::-1]), since row "
     "0 "
     "of a picture is its top and that of an array the smallest y"},
    {{".jpg", ".jpeg", ".bmp", ".gif", ".webp"}, "save the picture as .png"},
    {{".svg", ".pdf", ".eps"}, "export the drawing as .png"},
    {{".csv", ".tsv", ".txt", ".dat", ".asc"},
     "convert it with Python: numpy.save(\"field.npy\", numpy.loadtxt(FILE)), rows along y from "
     "the "
     "smallest, columns along x; delimiter=\",\" for commas"},
    {{".nc", ".nc4", ".cdf"},
     "convert it with Python: numpy.save(\"field.npy\", xarray.open_dataset(FILE)[NAME]"
     ".transpose(\"y\", \"x\"))"},
    {{".hdf5", ".hdf", ".he5"},
     "rename a recording of prostm to .h5; convert another program's data set with Python: "
     "numpy.save(\"field.npy\", h5py.File(FILE)[NAME][()]), axes y, x, or with .T for MATLAB's and "
     "Julia's"},
    {{".pt", ".pth", ".pkl", ".pickle"},
     "convert it with Python: numpy.save(\"field.npy\", array), axes y, x"},
}};

}  // namespace

std::string conversion_hint(std::string_view ending) {
  if (ending.empty()) return {};
  for (const Conversion& known : kConversions) {
    if (std::ranges::find(known.endings, ending) != known.endings.end())
      return std::string(known.hint);
  }
  return {};
}

}  // namespace prostm
