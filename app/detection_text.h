#pragma once
#include "amontons/solution/run.h"

#include <string>
#include <vector>

namespace amontons
{
/// What one detection found and cost, for the eye.
std::string detection_text(const ContactCheck &contact);

/// The same for programs: a list with one object per contact, all fields of DetectionReport under their names.
std::string detection_json(const std::vector<ContactCheck> &contacts);
} // namespace amontons
