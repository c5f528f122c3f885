#include "server/parsing/sdf/urdf/urdf_file.hpp"

#include "server/parsing/sdf/tree/xml_edit.hpp"
#include "server/parsing/sdf/urdf/convert_urdf.hpp"
#include "server/parsing/sdf/urdf/mend_urdf.hpp"

namespace cohort::parsing {

std::optional<XmlNode> sdf_of_urdf(XmlNode robot, const std::filesystem::path& file, std::vector<Problem>& problems,
                                   std::vector<Problem>& warnings) {
  const std::size_t before = problems.size();
  mend_urdf(robot, file, problems, warnings);
  check_urdf(robot, file, problems, warnings);
  if (problems.size() > before) return std::nullopt;
  XmlNode sdf = element_at(robot, "sdf");
  sdf.attributes = {{"version", "1.9"}, {"xmlns:cohort", "https://cohort-sim.org/sdf/1"}};
  sdf.children.push_back(convert_urdf(robot, file, warnings));
  return sdf;
}

}  // namespace cohort::parsing
