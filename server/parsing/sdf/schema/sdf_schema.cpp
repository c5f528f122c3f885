#include "server/parsing/sdf/schema/sdf_schema.hpp"

#include <algorithm>
#include <memory>
#include <sdf/parser.hh>

namespace cohort::parsing {
namespace {

bool is_vector_type(std::string_view type) {
  constexpr std::string_view types[] = {"pose", "vector2d", "vector2i", "vector3", "color", "quaternion"};
  return std::find(std::begin(types), std::end(types), type) != std::end(types);
}

const ExtensionKey* find_key(const Extension& extension, std::string_view name) {
  for (const ExtensionKey& key : extension.keys)
    if (key.name == name) return &key;
  return nullptr;
}

}  // namespace

const sdf::ElementPtr& sdf_definition() {
  static const sdf::ElementPtr root = [] {
    const sdf::SDFPtr sdf = std::make_shared<sdf::SDF>();
    sdf::init(sdf);
    return sdf->Root();
  }();
  return root;
}

ElementSchema ElementSchema::root() {
  ElementSchema schema;
  schema.name_ = "sdf";
  schema.element_ = sdf_definition();
  return schema;
}

ElementSchema ElementSchema::child(const std::string& name) const {
  ElementSchema schema;
  schema.name_ = name;
  if (is_extension() || has_prefix(name)) {
    schema.name_ = without_prefix(name);
    schema.extension_ = find_extension(schema.name_, name_);
    if (extension_ != nullptr) schema.key_ = find_key(*extension_, schema.name_);
    schema.unknown_extension_ = schema.extension_ == nullptr && schema.key_ == nullptr;
  } else if (element_ && !element_->GetCopyChildren()) {
    // The schema of a nested model is that of the model.
    const bool is_same = name == name_ && element_->HasElementDescription(name);
    schema.element_ = is_same ? element_ : element_->GetElementDescription(name);
  }
  return schema;
}

bool ElementSchema::takes_anything() const { return is_free() || (element_ && element_->GetCopyChildren()); }

bool ElementSchema::has_child(const std::string& name) const {
  const std::vector<std::string> known = children();
  return std::find(known.begin(), known.end(), is_extension() ? prefixed(name) : name) != known.end();
}

bool ElementSchema::has_attribute(const std::string& name) const {
  const std::vector<std::string> known = attributes();
  return std::find(known.begin(), known.end(), name) != known.end();
}

bool ElementSchema::knows_child(const std::string& name) const {
  return !element_ || element_->GetCopyChildren() || element_->HasElementDescription(name);
}

bool ElementSchema::knows_attribute(const std::string& name) const {
  return !element_ || element_->GetAttribute(name) != nullptr;
}

bool ElementSchema::is_single() const {
  // For these included elements, libsdformat does not keep the number that SDF allows.
  if (name_ == "sensor" || name_ == "projector") return false;
  return element_ && (element_->GetRequired() == "0" || element_->GetRequired() == "1");
}

bool ElementSchema::has_value() const {
  if (element_) return static_cast<bool>(element_->GetValue());
  if (key_ != nullptr) return key_->value != ExtensionValue::group;
  return extension_ != nullptr && extension_->value != ExtensionValue::group;
}

bool ElementSchema::can_have(const std::string& text) const {
  return !element_ || !element_->GetValue() || element_->GetValue()->Clone()->SetFromString(text);
}

std::string ElementSchema::default_text() const {
  return element_ && element_->GetValue() ? element_->GetValue()->GetDefaultAsString() : std::string();
}

bool ElementSchema::is_vector() const {
  if (element_) return element_->GetValue() && is_vector_type(element_->GetValue()->GetTypeName());
  constexpr ExtensionValue vectors[] = {ExtensionValue::point, ExtensionValue::vector, ExtensionValue::place,
                                        ExtensionValue::pose};
  return key_ != nullptr && std::ranges::find(vectors, key_->value) != std::end(vectors);
}

std::vector<std::string> ElementSchema::children() const {
  std::vector<std::string> names;
  if (element_)
    for (unsigned i = 0; i < element_->GetElementDescriptionCount(); ++i)
      names.push_back(element_->GetElementDescription(i)->GetName());
  if (extension_ != nullptr)
    for (const ExtensionKey& key : extension_->keys) names.push_back(prefixed(key.name));
  for (const Extension& extension : extensions())
    if (extension.parent == name_) names.push_back(prefixed(extension.name));
  return names;
}

std::vector<std::string> ElementSchema::attributes() const {
  std::vector<std::string> names;
  if (element_)
    for (const sdf::ParamPtr& attribute : element_->GetAttributes()) names.push_back(attribute->GetKey());
  if (extension_ != nullptr && extension_->has_name) names.emplace_back("name");
  return names;
}

}  // namespace cohort::parsing
