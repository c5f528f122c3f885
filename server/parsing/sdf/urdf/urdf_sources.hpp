#pragma once

#include <map>
#include <sdf/Element.hh>
#include <set>
#include <string>
#include <vector>

#include "server/parsing/files/xml_outline.hpp"

namespace cohort::parsing {

/// The URDF elements from which libsdformat makes the elements of an SDF. It merges links that fixed joints connect,
/// and renames their collisions and visuals, but keeps their order.
class UrdfSources {
 public:
  /// Marks the elements inside <gazebo>, which libsdformat copies with their attributes. `robot` is what it converts.
  explicit UrdfSources(XmlNode& robot);

  /// Returns the <sdf> as a tree. Each element has the line of its source; parts of links have `written`.
  XmlNode tree(const sdf::ElementPtr& sdf);

 private:
  /// The source of an element, the link, joint or part of a link that contains it, and the name of that link or joint.
  struct Source {
    const XmlNode* node;
    const XmlNode* part;
    std::string owner;
  };

  void mark_below(XmlNode& node, const std::string& reference);
  XmlNode tree(const sdf::ElementPtr& element, const Source& source) const;
  Source source_of(const sdf::ElementPtr& element, const Source& around) const;
  /// Adds a link and the links that are merged into it, in the order of libsdformat.
  void collect_merged(const std::string& link, std::vector<const XmlNode*>& links) const;
  /// Returns the collisions and visuals of a link and of those merged into it, in the order of libsdformat, and the
  /// <inertial> to which messages about the sum refer.
  std::vector<Source> parts_of(const std::string& link) const;

  const XmlNode& robot_;
  std::vector<Source> marked_;
  std::map<std::string, const XmlNode*> links_;
  std::map<std::string, const XmlNode*> joints_;
  std::set<std::string> kept_;  // links of the SDF
};

}  // namespace cohort::parsing
