// SPDX-License-Identifier: BSL-1.0
#include "hdf5_layout.hpp"

#if defined NYSALT_HAS_HDF5
#include <fmt/format.h>
#include <hdf5.h>
#endif

#include <algorithm>
#include <bit>
#include <cstddef>
#include <new>
#include <stdexcept>

namespace nysalt::program {

#if defined NYSALT_HAS_HDF5

static_assert(std::endian::native == std::endian::little,
              "the numbers are put there as this machine has them");

namespace {

void require_done(std::int64_t result) {
  if (result < 0) throw std::runtime_error("cannot use HDF5: a call of it failed");
}

/// An object that the library knows by a number, closed when the handle goes.
class handle {
 public:
  handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) { require_done(id); }
  handle(const handle&) = delete;
  handle& operator=(const handle&) = delete;
  ~handle() {
    if (id_ >= 0) close_(id_);
  }
  /// For who closes it.
  hid_t release() { return std::exchange(id_, H5I_INVALID_HID); }
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// To be called first.
void set_up_library() {
  constexpr std::size_t needed = std::size_t{1} << 24U;  // bytes: far more than the library takes
  ::operator delete(::operator new(needed));             // where memory is short it crashes in its own set-up
  H5dont_atexit();  // after a full disk the library would try again at exit, and crash
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // errors are reported by us
}

/// The access properties of files, which this process may have locked itself; the version of the format is
/// always the same.
class file_access : public handle {
 public:
  file_access() : handle(H5Pcreate(H5P_FILE_ACCESS), H5Pclose) {
    require_done(H5Pset_file_locking(*this, false, true));
    require_done(H5Pset_libver_bounds(*this, H5F_LIBVER_V18, H5F_LIBVER_V18));
  }
};

/// Of any length, which Python reads as str.
hid_t type_of_text() {
  const hid_t type = H5Tcopy(H5T_C_S1);
  require_done(H5Tset_size(type, H5T_VARIABLE));
  require_done(H5Tset_cset(type, H5T_CSET_UTF8));
  return type;
}

void add_attribute(hid_t file, const std::string& name, hid_t type, hid_t space, const void* value) {
  const handle attribute(H5Acreate2(file, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  require_done(H5Awrite(attribute, type, value));
}

void add_attribute(hid_t file, const std::string& name, const json& value) {
  const handle one(H5Screate(H5S_SCALAR), H5Sclose);
  const auto is_number = [](const json& element) { return element.is_number(); };
  if (value.is_number_integer()) {
    const auto number = value.get<std::int64_t>();
    add_attribute(file, name, H5T_STD_I64LE, one, &number);
  } else if (value.is_number()) {
    const auto number = value.get<double>();
    add_attribute(file, name, H5T_IEEE_F64LE, one, &number);
  } else if (value.is_array() && !value.empty() && std::ranges::all_of(value, is_number)) {
    const auto numbers = value.get<std::vector<double>>();
    const hsize_t count = numbers.size();
    const handle all(H5Screate_simple(1, &count, nullptr), H5Sclose);
    add_attribute(file, name, H5T_IEEE_F64LE, all, numbers.data());
  } else {
    const handle type(type_of_text(), H5Tclose);
    const std::string text = value.is_string() ? value.get<std::string>()
                                               : value.dump(-1, ' ', false, json::error_handler_t::replace);
    const char* begin = text.c_str();
    add_attribute(file, name, type, one, static_cast<const void*>(&begin));
  }
}

void add_dataset(hid_t file, const dataset& added) {
  const std::vector<hsize_t> shape(added.shape.begin(), added.shape.end());
  const handle space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose);
  // One piece: a trajectory is read at once, and one time of all for a page of the disk each; pieces that
  // were good for both would need an index, which a killed run might leave behind in disorder.
  const handle how(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  require_done(H5Pset_layout(how, H5D_CONTIGUOUS));
  require_done(H5Pset_alloc_time(how, H5D_ALLOC_TIME_EARLY));
  require_done(H5Pset_fill_time(how, H5D_FILL_TIME_NEVER));
  require_done(H5Pset_obj_track_times(how, false));
  const hid_t type = added.is_of_integers ? H5T_STD_I64LE : H5T_IEEE_F64LE;
  const handle made(H5Dcreate2(file, added.name.c_str(), type, space, H5P_DEFAULT, how, H5P_DEFAULT),
                    H5Dclose);
}

}  // namespace

bool has_hdf5() { return true; }

std::string hdf5_version() { return fmt::format("{}.{}.{}", H5_VERS_MAJOR, H5_VERS_MINOR, H5_VERS_RELEASE); }

void make_hdf5(const std::filesystem::path& file, const std::vector<dataset>& datasets,
               const json& attributes) {
  set_up_library();
  const handle how(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  require_done(H5Pset_obj_track_times(how, false));
  handle made(H5Fcreate(file.c_str(), H5F_ACC_TRUNC, how, file_access()), H5Fclose);
  for (const auto& [name, value] : attributes.items()) add_attribute(made, name, value);
  for (const auto& one : datasets) add_dataset(made, one);
  require_done(H5Fflush(made, H5F_SCOPE_GLOBAL));
  require_done(H5Fclose(made.release()));
}

std::vector<std::uint64_t> places_in_hdf5(const std::filesystem::path& file,
                                          const std::vector<dataset>& datasets) {
  set_up_library();
  const handle opened(H5Fopen(file.c_str(), H5F_ACC_RDONLY, file_access()), H5Fclose);
  std::vector<std::uint64_t> places;
  for (const auto& one : datasets) {
    const handle found(H5Dopen2(opened, one.name.c_str(), H5P_DEFAULT), H5Dclose);
    places.push_back(H5Dget_offset(found));
    if (places.back() == HADDR_UNDEF) throw std::runtime_error("a dataset must have a place");
  }
  return places;
}

std::string text_in_hdf5(const std::filesystem::path& file, const std::string& name) {
  set_up_library();
  const handle opened(H5Fopen(file.c_str(), H5F_ACC_RDONLY, file_access()), H5Fclose);
  const handle attribute(H5Aopen(opened, name.c_str(), H5P_DEFAULT), H5Aclose);
  const handle type(type_of_text(), H5Tclose);
  char* text = nullptr;
  require_done(H5Aread(attribute, type, static_cast<void*>(&text)));
  std::string result(text == nullptr ? "" : text);
  H5free_memory(text);
  return result;
}

std::vector<std::pair<dataset, std::uint64_t>> datasets_in_hdf5(const std::filesystem::path& file) {
  set_up_library();
  const handle opened(H5Fopen(file.c_str(), H5F_ACC_RDONLY, file_access()), H5Fclose);
  H5G_info_t links{};
  require_done(H5Gget_info(opened, &links));
  std::vector<std::pair<dataset, std::uint64_t>> all;
  for (hsize_t i = 0; i < links.nlinks; ++i) {
    const auto name_of = [&](char* name, std::size_t room) {
      return H5Lget_name_by_idx(opened, ".", H5_INDEX_NAME, H5_ITER_INC, i, name, room, H5P_DEFAULT);
    };
    const auto length = name_of(nullptr, 0);
    require_done(length);
    std::string name(static_cast<std::size_t>(length) + 1, '\0');
    require_done(name_of(name.data(), name.size()));
    name.pop_back();
    const hid_t found = H5Dopen2(opened, name.c_str(), H5P_DEFAULT);
    if (found < 0) continue;  // no dataset
    const handle one(found, H5Dclose);
    const handle type(H5Dget_type(one), H5Tclose);
    const handle space(H5Dget_space(one), H5Sclose);
    const int dimensions = H5Sget_simple_extent_ndims(space);
    require_done(dimensions);
    std::vector<hsize_t> shape(static_cast<std::size_t>(dimensions));
    require_done(H5Sget_simple_extent_dims(space, shape.data(), nullptr));
    const bool is_of_integers = H5Tequal(type, H5T_STD_I64LE) > 0;
    const haddr_t first = H5Dget_offset(one);
    if (first == HADDR_UNDEF || (!is_of_integers && H5Tequal(type, H5T_IEEE_F64LE) <= 0)) continue;
    all.push_back({{name, {shape.begin(), shape.end()}, is_of_integers}, first});
  }
  return all;
}

#else

bool has_hdf5() { return false; }
std::string hdf5_version() { return ""; }
void make_hdf5(const std::filesystem::path&, const std::vector<dataset>&, const json&) {}
std::vector<std::uint64_t> places_in_hdf5(const std::filesystem::path&, const std::vector<dataset>&) {
  return {};
}
std::string text_in_hdf5(const std::filesystem::path&, const std::string&) { return ""; }
std::vector<std::pair<dataset, std::uint64_t>> datasets_in_hdf5(const std::filesystem::path&) { return {}; }

#endif

}  // namespace nysalt::program
