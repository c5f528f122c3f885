// SPDX-License-Identifier: Apache-2.0
#include "tools/common/data/hdf5_tables.hpp"

#include <hdf5.h>

#include <array>
#include <cstring>
#include <optional>
#include <string_view>
#include <utility>

#include "server/core/atomic_file.hpp"

namespace cohort::data {
namespace {

constexpr hsize_t rows_a_chunk = 4096;
constexpr unsigned compression_level = 4;

// The innermost reason that the library gives; of the system's if there is one, among details of the library's.
std::string last_error() {
  std::string text;
  H5Ewalk2(
      H5E_DEFAULT, H5E_WALK_UPWARD,
      [](unsigned, const H5E_error2_t* error, void* data) -> herr_t {
        auto& reason = *static_cast<std::string*>(data);
        if (reason.empty() && error->desc != nullptr) reason = error->desc;
        return 0;
      },
      &text);
  constexpr std::string_view before = "error message = '";
  const std::size_t of_system = text.find(before);
  if (of_system == std::string::npos) return text;
  const std::size_t begin = of_system + before.size();
  return text.substr(begin, text.find('\'', begin) - begin);
}

// A handle of the library, closed as its kind wants it.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle(hid_t id, Close close_it, const std::filesystem::path& file) : id_(id), close_(close_it) {
    if (id < 0) throw WriteError(file.string() + " cannot be written as HDF5: " + last_error());
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  herr_t close() { return close_(std::exchange(id_, -1)); }
  hid_t id() const { return id_; }

 private:
  hid_t id_;
  Close close_;
};

void check(herr_t result, const std::filesystem::path& file) {
  if (result < 0) throw WriteError(file.string() + " cannot be written: " + last_error());
}

hid_t text_type() {
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, H5T_VARIABLE);
  H5Tset_cset(type, H5T_CSET_UTF8);
  return type;
}

// Every cell takes eight bytes in a row: a number, or a pointer to a text.
class Hdf5Table final : public TableWriter {
 public:
  Hdf5Table(std::filesystem::path file, hid_t parent, const std::string& name, const std::vector<Column>& columns)
      : file_(std::move(file)),
        text_(text_type(), H5Tclose, file_),
        row_(H5Tcreate(H5T_COMPOUND, columns.size() * cell_size), H5Tclose, file_),
        dataset_(create(parent, name, columns), H5Dclose, file_),
        width_(columns.size()) {
    write_units(columns);
  }

  void add(std::span<const Cell> row) override {
    for (const Cell& cell : row) {
      std::array<std::byte, cell_size> bytes{};
      if (const auto* const text = std::get_if<std::string>(&cell)) {
        texts_.push_back(std::make_unique<std::string>(*text));
        const char* const pointer = texts_.back()->c_str();
        std::memcpy(bytes.data(), &pointer, sizeof pointer);
      } else if (const auto* const whole = std::get_if<std::uint64_t>(&cell)) {
        std::memcpy(bytes.data(), whole, sizeof *whole);
      } else {
        std::memcpy(bytes.data(), &std::get<double>(cell), sizeof(double));
      }
      rows_.insert(rows_.end(), bytes.begin(), bytes.end());
    }
    if (rows_.size() == rows_a_chunk * width_ * cell_size) write_rows();
  }

  void finish() override { write_rows(); }

 private:
  static constexpr std::size_t cell_size = 8;

  void write_rows() {
    if (rows_.empty()) return;
    const hsize_t count = rows_.size() / (width_ * cell_size);
    const hsize_t size = written_ + count;
    check(H5Dset_extent(dataset_.id(), &size), file_);
    const Handle space(H5Dget_space(dataset_.id()), H5Sclose, file_);
    check(H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, &written_, nullptr, &count, nullptr), file_);
    const Handle memory(H5Screate_simple(1, &count, nullptr), H5Sclose, file_);
    check(H5Dwrite(dataset_.id(), row_.id(), memory.id(), space.id(), H5P_DEFAULT, rows_.data()), file_);
    written_ = size;
    rows_.clear();
    texts_.clear();
  }

  hid_t create(hid_t parent, const std::string& name, const std::vector<Column>& columns) {
    std::size_t offset = 0;
    for (const Column& column : columns) {
      const hid_t type = column.type == Column::Type::real    ? H5T_NATIVE_DOUBLE
                         : column.type == Column::Type::whole ? H5T_NATIVE_UINT64
                                                              : text_.id();
      check(H5Tinsert(row_.id(), column.name.c_str(), offset, type), file_);
      offset += cell_size;
    }
    const hsize_t none = 0;
    const hsize_t unlimited = H5S_UNLIMITED;
    const Handle space(H5Screate_simple(1, &none, &unlimited), H5Sclose, file_);
    const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, file_);
    check(H5Pset_chunk(properties.id(), 1, &rows_a_chunk), file_);
    check(H5Pset_shuffle(properties.id()), file_);
    check(H5Pset_deflate(properties.id(), compression_level), file_);
    return H5Dcreate2(parent, name.c_str(), row_.id(), space.id(), H5P_DEFAULT, properties.id(), H5P_DEFAULT);
  }

  void write_units(const std::vector<Column>& columns) {
    std::vector<const char*> units;
    units.reserve(columns.size());
    for (const Column& column : columns) units.push_back(column.unit.c_str());
    const hsize_t count = units.size();
    const Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose, file_);
    const Handle attribute(H5Acreate2(dataset_.id(), "units", text_.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT),
                           H5Aclose, file_);
    check(H5Awrite(attribute.id(), text_.id(), units.data()), file_);
  }

  std::filesystem::path file_;
  Handle text_;
  Handle row_;
  Handle dataset_;
  std::size_t width_;
  hsize_t written_ = 0;
  std::vector<std::byte> rows_;
  std::vector<std::unique_ptr<std::string>> texts_;  // that `rows_` point to
};

class Hdf5Tables final : public TableSink {
 public:
  explicit Hdf5Tables(const std::filesystem::path& path)
      : path_(path),
        beside_("the tables", path),
        file_(std::in_place,
              // A file that a full disk has kept from being closed would crash the library when it ends.
              (H5dont_atexit(), H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr),  // errors are ours to tell
               H5Fcreate(beside_.path().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT)),
              H5Fclose, path) {}

  std::unique_ptr<TableWriter> begin(const std::string& name, const std::vector<Column>& columns) override {
    return std::make_unique<Hdf5Table>(path_, file_->id(), name, columns);
  }
  void finish() override {
    check(H5Fflush(file_->id(), H5F_SCOPE_GLOBAL), path_);
    check(file_->close(), path_);
    beside_.commit();
  }

 private:
  std::filesystem::path path_;
  AtomicFile beside_;
  std::optional<Handle> file_;
};

}  // namespace

std::unique_ptr<TableSink> hdf5_tables(const std::filesystem::path& file) { return std::make_unique<Hdf5Tables>(file); }

}  // namespace cohort::data
