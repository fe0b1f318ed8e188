// SPDX-License-Identifier: Apache-2.0
#include "codec/files/composed.h"

#include <algorithm>
#include <array>

#include "codec/core/printable.h"

namespace vitrine::inline codec {
namespace {

struct Mark {
  std::string_view mark;
  // Letters, each followed by the character that the letter and the mark form.
  std::string_view pairs;
};

// The marks of Latin, Greek, Cyrillic and Japanese that form one Unicode character with a letter
// [UAX15].
constexpr std::array<Mark, 27> kMarks{
    {{"\xCC\x80", "AÀEÈIÌOÒUÙaàeèiìoòuùÜǛüǜNǸnǹЕЀИЍеѐиѝĒḔēḕŌṐōṑWẀwẁÂẦâầĂẰăằÊỀêềÔỒôồƠỜơờƯỪưừYỲyỳ"},
     {"\xCC\x81",
      "AÁEÉIÍOÓUÚYÝaáeéiíoóuúyýCĆcćLĹlĺNŃnńRŔrŕSŚsśZŹzźÜǗüǘGǴgǵÅǺåǻÆǼæǽØǾøǿ¨΅ΑΆΕΈΗΉΙΊΟΌΥΎΩΏϊΐαά"
      "εέηήιίϋΰοόυύωώϒϓГЃКЌгѓкќÇḈçḉĒḖēḗÏḮïḯKḰkḱMḾmḿÕṌõṍŌṒōṓPṔpṕŨṸũṹWẂwẃÂẤâấĂẮăắÊẾêếÔỐôốƠỚơớƯỨưứ"},
     {"\xCC\x82", "AÂEÊIÎOÔUÛaâeêiîoôuûCĈcĉGĜgĝHĤhĥJĴjĵSŜsŝWŴwŵYŶyŷZẐzẑẠẬạậẸỆẹệỌỘọộ"},
     {"\xCC\x83", "AÃNÑOÕaãnñoõIĨiĩUŨuũVṼvṽÂẪâẫĂẴăẵEẼeẽÊỄêễÔỖôỗƠỠơỡƯỮưữYỸyỹ"},
     {"\xCC\x84", "AĀaāEĒeēIĪiīOŌoōUŪuūÜǕüǖÄǞäǟȦǠȧǡÆǢæǣǪǬǫǭÖȪöȫÕȬõȭȮȰȯȱYȲyȳИӢиӣУӮуӯGḠgḡḶḸḷḹṚṜṛṝ"},
     {"\xCC\x86", "AĂaăEĔeĕGĞgğIĬiĭOŎoŏUŬuŭУЎИЙийуўЖӁжӂАӐаӑЕӖеӗȨḜȩḝẠẶạặ"},
     {"\xCC\x87",
      "CĊcċEĖeėGĠgġIİZŻzżAȦaȧOȮoȯBḂbḃDḊdḋFḞfḟHḢhḣMṀmṁNṄnṅPṖpṗRṘrṙSṠsṡŚṤśṥŠṦšṧṢṨṣṩTṪtṫWẆwẇXẊxẋYẎ"
      "yẏſẛ"},
     {"\xCC\x88",
      "AÄEËIÏOÖUÜaäeëiïoöuüyÿYŸΙΪΥΫιϊυϋϒϔЕЁІЇеёіїАӒаӓӘӚәӛЖӜжӝЗӞзӟИӤиӥОӦоӧӨӪөӫЭӬэӭУӰуӱЧӴчӵЫӸыӹHḦ"
      "hḧÕṎõṏŪṺūṻWẄwẅXẌxẍtẗ"},
     {"\xCC\x89", "AẢaảÂẨâẩĂẲăẳEẺeẻÊỂêểIỈiỉOỎoỏÔỔôổƠỞơởUỦuủƯỬưửYỶyỷ"},
     {"\xCC\x8A", "AÅaåUŮuůwẘyẙ"},
     {"\xCC\x8B", "OŐoőUŰuűУӲуӳ"},
     {"\xCC\x8C", "CČcčDĎdďEĚeěLĽlľNŇnňRŘrřSŠsšTŤtťZŽzžAǍaǎIǏiǐOǑoǒUǓuǔÜǙüǚGǦgǧKǨkǩƷǮʒǯjǰHȞhȟ"},
     {"\xCC\x8F", "AȀaȁEȄeȅIȈiȉOȌoȍRȐrȑUȔuȕѴѶѵѷ"},
     {"\xCC\x91", "AȂaȃEȆeȇIȊiȋOȎoȏRȒrȓUȖuȗ"},
     {"\xCC\x9B", "OƠoơUƯuư"},
     {"\xCC\xA3",
      "BḄbḅDḌdḍHḤhḥKḲkḳLḶlḷMṂmṃNṆnṇRṚrṛSṢsṣTṬtṭVṾvṿWẈwẉZẒzẓAẠaạEẸeẹIỊiịOỌoọƠỢơợUỤuụƯỰưựYỴyỵ"},
     {"\xCC\xA4", "UṲuṳ"},
     {"\xCC\xA5", "AḀaḁ"},
     {"\xCC\xA6", "SȘsșTȚtț"},
     {"\xCC\xA7", "CÇcçGĢgģKĶkķLĻlļNŅnņRŖrŗSŞsşTŢtţEȨeȩDḐdḑHḨhḩ"},
     {"\xCC\xA8", "AĄaąEĘeęIĮiįUŲuųOǪoǫ"},
     {"\xCC\xAD", "DḒdḓEḘeḙLḼlḽNṊnṋTṰtṱUṶuṷ"},
     {"\xCC\xAE", "HḪhḫ"},
     {"\xCC\xB0", "EḚeḛIḬiḭUṴuṵ"},
     {"\xCC\xB1", "BḆbḇDḎdḏKḴkḵLḺlḻNṈnṉRṞrṟTṮtṯZẔzẕhẖ"},
     {"\xE3\x82\x99",
      "かがきぎくぐけげこごさざしじすずせぜそぞただちぢつづてでとどはばひびふぶへべほぼうゔゝゞ"
      "カガキギクグケゲコゴサザシジスズセゼソゾタダチヂツヅテデトドハバヒビフブヘベホボウヴワヷ"
      "ヰヸヱヹヲヺヽヾ"},
     {"\xE3\x82\x9A", "はぱひぴふぷへぺほぽハパヒピフプヘペホポ"}}};

std::string_view first_character(std::string_view text) {
  return text.substr(0, std::max<std::size_t>(utf8_size(text), 1));
}

// Returns the character that `letter` and `mark` form, or an empty text if there is none.
std::string_view joined(std::string_view letter, std::string_view mark) {
  const auto known = std::ranges::find(kMarks, mark, &Mark::mark);
  if (known == kMarks.end()) return {};
  for (std::string_view rest = known->pairs; !rest.empty();) {
    const std::string_view base = first_character(rest);
    rest.remove_prefix(base.size());
    const std::string_view both = first_character(rest);
    rest.remove_prefix(both.size());
    if (base == letter) return both;
  }
  return {};
}

}  // namespace

std::string composed(std::string_view text) {
  std::string out;
  std::size_t last = 0;  // where the last character of `out` starts
  while (!text.empty()) {
    const std::string_view next = first_character(text);
    text.remove_prefix(next.size());
    const std::string_view both = joined(std::string_view(out).substr(last), next);
    if (both.empty()) {
      last = out.size();
      out += next;
    } else {
      out.replace(last, out.npos, both);
    }
  }
  return out;
}

}  // namespace vitrine::inline codec
