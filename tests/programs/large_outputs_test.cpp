// SPDX-License-Identifier: BSL-1.0
// Outputs of `run` as arrays: the numbers of the table to the bit, also while the file is under way.
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "../support/stopping.hpp"

#if defined NYSALT_HAS_HDF5
#include <hdf5.h>
#endif

using namespace nysalt::test;

namespace {

struct array {
  std::vector<std::uint64_t> shape;
  std::vector<double> numbers;  // in C order
};

/// Of doubles, version 1.0.
array read_npy(const std::filesystem::path& file) {
  std::ifstream input(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(input), {}};
  if (text.substr(0, 8) != std::string("\x93NUMPY\x01\x00", 8)) throw std::runtime_error("no .npy");
  const auto byte = [&](std::size_t i) {
    return static_cast<std::size_t>(static_cast<unsigned char>(text[i]));
  };
  const std::size_t begin = 10 + byte(8) + 256 * byte(9);
  const std::string head = text.substr(10, begin - 10);
  if (begin % 64 != 0 || head.back() != '\n' || head.find("'descr': '<f8'") == std::string::npos ||
      head.find("'fortran_order': False") == std::string::npos) {
    throw std::runtime_error("another head");
  }
  array result;
  std::uint64_t count = 1;
  const char* rest = head.c_str() + head.find("'shape': (") + 10;
  for (char* end = nullptr; *rest != ')'; rest = end + std::strspn(end, ", ")) {
    result.shape.push_back(std::strtoull(rest, &end, 10));
    count *= result.shape.back();
  }
  result.numbers.resize(count);
  if (!nlohmann::json::accept(text.substr(begin + 8 * count))) throw std::runtime_error("another end");
  std::memcpy(result.numbers.data(), text.data() + begin, 8 * count);
  return result;
}

#if defined NYSALT_HAS_HDF5
/// A dataset; whole numbers too, as doubles.
array read_hdf5(const std::filesystem::path& file, const std::string& name) {
  const hid_t opened = H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t data = H5Dopen2(opened, name.c_str(), H5P_DEFAULT);
  if (data < 0) throw std::runtime_error("no dataset " + name);
  const hid_t space = H5Dget_space(data);
  std::vector<hsize_t> shape(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space)));
  H5Sget_simple_extent_dims(space, shape.data(), nullptr);
  array result{{shape.begin(), shape.end()},
               std::vector<double>(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)))};
  if (H5Dread(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, result.numbers.data()) < 0) {
    throw std::runtime_error("cannot read " + name);
  }
  H5Sclose(space);
  H5Dclose(data);
  H5Fclose(opened);
  return result;
}

/// The value of an attribute of that type; a text is its address.
template <class T>
T attribute_in_hdf5(const std::filesystem::path& file, const std::string& name) {
  const hid_t opened = H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t attribute = H5Aopen(opened, name.c_str(), H5P_DEFAULT);
  if (attribute < 0) throw std::runtime_error("no attribute " + name);
  const hid_t type = H5Aget_type(attribute);
  T value{};
  H5Aread(attribute, std::is_pointer_v<T> ? type : H5T_NATIVE_DOUBLE, &value);
  H5Tclose(type);
  H5Aclose(attribute);
  H5Fclose(opened);
  return value;
}
/// A text, which HDF5 allocates.
std::string text_in_hdf5(const std::filesystem::path& file, const std::string& name) {
  char* text = attribute_in_hdf5<char*>(file, name);
  std::string result = text;
  H5free_memory(text);
  return result;
}
#endif

// Noise, and several blocks of lanes.
const std::string in_bath =
    "run --system fpu --friction 0.01 --sigma 0.05 --start law --method baoab --step 0.01 --trajectories 37 "
    "--observables stiff_energy,q1,p6 --horizon 40 --sample-every 70 ";
// Some of them diverge, at several steps.
const std::string with_losses =
    "run --system henon_heiles --spread 2.5 --method verlet --step 0.3 --horizon 600 --trajectories 40 "
    "--sample-every 7 --observables energy,q2 ";

const std::vector<std::string> kinds {
#if defined NYSALT_HAS_HDF5
  ".h5",
#endif
      ".npy"
};

void done(const scratch& folder, const std::string& line) {
  const auto result = run(folder, line);
  BOOST_TEST_REQUIRE(result.code == 0, line << ": " << result.err);
}

/// The numbers of a table of samples where arrays have them, observable by observable; elsewhere NaN.
std::vector<std::vector<double>> numbers_of(const std::filesystem::path& table, std::size_t trajectories,
                                            std::size_t samples, int every) {
  std::istringstream lines(contents(table));
  std::string line;
  while (std::getline(lines, line) && line.starts_with('#')) {
  }
  const auto columns = static_cast<std::size_t>(std::count(line.begin(), line.end(), ',') - 2);
  std::vector<std::vector<double>> all(columns, std::vector<double>(trajectories * samples, std::nan("")));
  while (std::getline(lines, line)) {
    char* rest = line.data();
    const std::uint64_t m = std::strtoull(rest, &rest, 10);
    const std::uint64_t i = std::strtoull(rest + 1, &rest, 10) / static_cast<std::uint64_t>(every);
    std::strtod(rest + 1, &rest);
    for (auto& column : all) column[m * samples + i] = std::strtod(rest + 1, &rest);
  }
  return all;
}

/// Of observable k, trajectory by trajectory.
std::vector<double> values(const std::filesystem::path& file, std::size_t k, const std::string& name) {
#if defined NYSALT_HAS_HDF5
  if (file.string().find(".h5") != std::string::npos) return read_hdf5(file, name).numbers;
#endif
  const array all = read_npy(file);
  std::vector<double> result;
  for (std::size_t i = k; i < all.numbers.size(); i += all.shape[2]) result.push_back(all.numbers[i]);
  return result;
}

bool are_equal(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b) ||
         (std::isnan(a) && std::isnan(b));
}

}  // namespace

BOOST_AUTO_TEST_CASE(arrays_hold_the_numbers_of_the_table_to_the_bit) {
  struct asked {
    std::string line;
    std::vector<std::string> names;
    std::size_t trajectories;
    std::size_t samples;
    int every;
  };
  for (const auto& request : {asked{in_bath, {"stiff_energy", "q1", "p6"}, 37, 58, 70},
                              asked{with_losses, {"energy", "q2"}, 40, 286, 7}}) {
    const scratch folder("arrays");
    done(folder, request.line + "--output a.csv");
    const auto expected = numbers_of(folder / "a.csv", request.trajectories, request.samples, request.every);
    for (const auto& kind : kinds) {
      done(folder, request.line + "--output a" + kind);
      done(folder, request.line + "--seed 2 --output other" + kind);
      BOOST_TEST(!std::filesystem::exists(folder / ("a" + kind + ".part")));
      for (std::size_t k = 0; k < request.names.size(); ++k) {
        const auto found = values(folder / ("a" + kind), k, request.names[k]);
        BOOST_TEST(std::ranges::equal(found, expected[k], are_equal),
                   request.line << kind << request.names[k]);
        const auto other = values(folder / ("other" + kind), k, request.names[k]);
        BOOST_TEST(!std::ranges::equal(other, expected[k], are_equal));
      }
    }
  }
}

#if defined NYSALT_HAS_HDF5
BOOST_AUTO_TEST_CASE(a_file_of_hdf5_tells_what_it_is) {
  const scratch folder("arrays_hdf5");
  const auto told = run(folder, with_losses + "--output a.h5 --json");
  BOOST_TEST_REQUIRE(told.code == 0, told.err);
  const std::string file = folder / "a.h5";
  const array step = read_hdf5(file, "step");
  const array t = read_hdf5(file, "t");
  BOOST_TEST_REQUIRE(step.numbers.size() == 286U);
  for (std::size_t i = 0; i < step.numbers.size(); ++i) {
    if (step.numbers[i] != 7.0 * static_cast<double>(i)) BOOST_ERROR("step of sample " << i);
    if (t.numbers[i] != step.numbers[i] * 0.3) BOOST_ERROR("t of sample " << i);
  }
  std::vector<double> lost(40, -1.0);
  const auto document = json_of(told);
  for (const auto& one : document["diverged"]) lost[one["trajectory"].get<std::size_t>()] = one["step"];
  BOOST_TEST(std::ranges::count(lost, -1.0) < 38);  // else it would say little
  BOOST_TEST(read_hdf5(file, "diverged_at").numbers == lost, boost::test_tools::per_element());
  BOOST_TEST(text_in_hdf5(file, "format") == "nysalt run");
  BOOST_TEST(text_in_hdf5(file, "method") == "verlet");
  BOOST_TEST(text_in_hdf5(file, "observables") == "energy, q2");
  BOOST_TEST(nlohmann::ordered_json::parse(text_in_hdf5(file, "system"))["spread"] == 2.5);
  BOOST_TEST(attribute_in_hdf5<double>(file, "step") == 0.3);
  BOOST_TEST(attribute_in_hdf5<double>(file, "seed") == 1.0);
  const auto verlet = attribute_in_hdf5<std::array<double, 3>>(file, "coefficients");
  BOOST_TEST((verlet == std::array<double, 3>{0.5, 1.0, 0.5}));
}
#endif

BOOST_AUTO_TEST_CASE(killed_it_can_be_read) {
  for (const auto& kind : kinds) {
    const scratch folder("arrays_killed");
    done(folder, in_bath + "--output whole" + kind);
    BOOST_TEST(is_killed_at(folder, "rename:3", in_bath + "--output a" + kind + " --every 500"));
    const auto of_part = values(folder / ("a" + kind + ".part"), 1, "q1");
    const auto of_whole = values(folder / ("whole" + kind), 1, "q1");
    std::size_t missing = 0;
    for (std::size_t i = 0; i < of_whole.size(); ++i) {
      missing += std::isnan(of_part[i]) ? 1U : 0U;
      if (!std::isnan(of_part[i]) && of_part[i] != of_whole[i]) BOOST_ERROR(i << " is another number");
    }
    BOOST_TEST(missing > 0U);
    BOOST_TEST(missing < of_whole.size());
  }
}
