#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <sdf/Element.hh>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "server/core/pose.hpp"
#include "server/description/extensions.hpp"
#include "server/description/sdf_report.hpp"

namespace cohort::description {

/// A `cohort:` element that holds all that its table entry asks for.
class ExtensionValues {
 public:
  /// Nothing if anything is wrong with the element; the report then has it.
  static std::optional<ExtensionValues> read(const sdf::ElementPtr& element, const Extension& extension,
                                             const SdfReport& report);

  const sdf::ElementPtr& element() const { return element_; }
  /// The attribute `name`.
  const std::string& name() const { return name_; }

  const std::string& text(std::string_view key) const { return std::get<std::string>(values_.at(key)); }
  double real(std::string_view key) const { return std::get<double>(values_.at(key)); }
  std::uint64_t whole(std::string_view key) const { return std::get<std::uint64_t>(values_.at(key)); }
  const Eigen::Vector2d& point(std::string_view key) const { return std::get<Eigen::Vector2d>(values_.at(key)); }
  const Pose& pose(std::string_view key) const { return std::get<Pose>(values_.at(key)); }

  /// The child element of this key, or the element itself if it is left to its fallback: where a problem with the value
  /// is.
  sdf::ElementPtr where(std::string_view key) const;

 private:
  using Value = std::variant<std::string, double, std::uint64_t, Eigen::Vector2d, Pose>;

  ExtensionValues() = default;
  bool read_name(const Extension& extension, const SdfReport& report);
  bool read_children(const Extension& extension, const SdfReport& report);
  bool read_child(const sdf::ElementPtr& child, const ExtensionKey& key, const SdfReport& report);
  static std::optional<Value> parse(std::string_view text, ExtensionValue kind);

  sdf::ElementPtr element_;
  std::string name_;
  std::map<std::string_view, Value> values_;
};

/// Extensions among the children of `element`, in document order, each with its entry. A `cohort:` child that is none,
/// and any below the other children, is reported.
std::vector<std::pair<sdf::ElementPtr, const Extension*>> extensions_in(const sdf::ElementPtr& element,
                                                                        const SdfReport& report);

}  // namespace cohort::description
