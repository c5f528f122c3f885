#pragma once

#include <cstddef>
#include <optional>
#include <sdf/Element.hh>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "server/parsing/keys/extensions.hpp"
#include "server/parsing/keys/key_values.hpp"
#include "server/parsing/sdf/sdf_report.hpp"

namespace cohort::parsing {

/// What an element of another simulator says of a key of ours.
struct ForeignValue {
  std::string_view key;
  std::string text;
  sdf::ElementPtr where;  ///< it stands
};

/// A `cohort:` element that holds all that its table entry asks for. A key that is absent and has no fallback has no
/// value; an extension without keys has its value under its own name.
class ExtensionValues : public KeyValues {
 public:
  /// Nothing if anything is wrong with the element; the report then has it.
  static std::optional<ExtensionValues> read(const sdf::ElementPtr& element, const Extension& extension,
                                             const SdfReport& report);

  /// The same of an element of another simulator, of which `values` are known. A required key without a value is
  /// nothing; whoever found no value has reported it.
  static std::optional<ExtensionValues> from_foreign(const sdf::ElementPtr& element, const std::string& name,
                                                     const Extension& extension,
                                                     const std::vector<ForeignValue>& values, const SdfReport& report);

  const sdf::ElementPtr& element() const { return element_; }
  /// The attribute `name`.
  const std::string& name() const { return name_; }

  /// Puts `prefix` before its name and before every name that it refers to.
  void put_in_scope(const std::string& prefix, const Extension& extension);

  /// The child element of this key, the `place`-th of them if it repeats, or the element itself if it is left to its
  /// fallback: where a problem with the value is.
  sdf::ElementPtr where(std::string_view key, std::size_t place = 0) const;

 private:
  ExtensionValues() = default;
  bool read_name(const Extension& extension, const SdfReport& report);
  bool read_children(const Extension& extension, const SdfReport& report);
  bool read_value(const sdf::ElementPtr& element, const ExtensionKey& key, const SdfReport& report);

  sdf::ElementPtr element_;
  std::string name_;
  std::vector<ForeignValue> foreign_;
};

/// Extensions among the children of `element`, in document order, each with its entry. A `cohort:` child that is none,
/// and any below the other children that does not belong there, is reported.
std::vector<std::pair<sdf::ElementPtr, const Extension*>> extensions_in(const sdf::ElementPtr& element,
                                                                        const SdfReport& report);

}  // namespace cohort::parsing
