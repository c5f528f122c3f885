// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "server/parsing/keys/extensions.hpp"
#include "server/parsing/keys/key_values.hpp"
#include "server/parsing/sdf/sdf_report.hpp"

namespace cohort::parsing {

/// The value of a `cohort:` key from an element of another simulator.
struct ForeignValue {
  std::string_view key;
  std::string text;
  const Element* where;  ///< position of the value
};

/// The values of a `cohort:` element, complete according to its table entry. An absent key without a fallback has no
/// value; an extension without keys has its value under its own name.
class ExtensionValues : public KeyValues {
 public:
  /// Reads an element; returns nothing, with a report, if it is invalid.
  static std::optional<ExtensionValues> read(const Element* element, const Extension& extension,
                                             const SdfReport& report);

  /// Creates the values from an element of another simulator, whose `values` are known. Returns nothing if a required
  /// key has no value; the caller must have reported it.
  static std::optional<ExtensionValues> from_foreign(const Element* element, const std::string& name,
                                                     const Extension& extension,
                                                     const std::vector<ForeignValue>& values, const SdfReport& report);

  const Element* element() const { return element_; }
  /// Returns the attribute `name`.
  const std::string& name() const { return name_; }

  /// Adds `prefix` to the front of its name and of every name that it refers to.
  void put_in_scope(const std::string& prefix, const Extension& extension);

  /// Returns the element for problems with a value: the child element of this key, the `place`-th one if it repeats, or
  /// the element itself if the key is absent.
  const Element* where(std::string_view key, std::size_t place = 0) const;

 private:
  ExtensionValues() = default;
  bool read_name(const Extension& extension, const SdfReport& report);
  bool read_children(const Extension& extension, const SdfReport& report);
  bool read_value(const Element* element, const ExtensionKey& key, const SdfReport& report);

  const Element* element_;
  std::string name_;
  std::vector<ForeignValue> foreign_;
};

/// Returns the extensions among the children of `element`, in document order, each with its entry. Reports unknown
/// `cohort:` children, and those below other children where they are not allowed.
std::vector<std::pair<const Element*, const Extension*>> extensions_in(const Element* element, const SdfReport& report);

}  // namespace cohort::parsing
