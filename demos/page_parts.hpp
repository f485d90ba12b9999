// Pieces of HTML that entries and exhibits share.
#pragma once

#include "demos/page.hpp"

namespace nacre {

/// \param caption  HTML; \param below  HTML between picture and caption
std::string figureHtml(const Picture& picture, const std::string& alt, const std::string& caption,
                       const std::string& below = {});
/// Opens a column of `figures`, which stand level with those of the columns beside it.
std::string pairHtml(int figures);
/// A difference's colours and what their end stands for.
std::string scaleBarHtml(double scale);
std::string psnrText(double psnr);      ///< `45.2 dB`, or `identical`
std::string percentText(double share);  ///< `0.310 %`
/// A cell that shows its column's name where the table becomes a list, on narrow screens.
std::string cellHtml(const std::string& name, const std::string& value);
std::string headRowHtml(const std::vector<std::string>& names);

/// \throws std::invalid_argument unless it is made of a-z, 0-9 and dashes / the picture has bytes and a name / finite
void checkId(const std::string& id);
void checkPicture(const std::string& id, const Picture& picture);
double checkedFinite(const std::string& id, const char* field, double value);

}  // namespace nacre
