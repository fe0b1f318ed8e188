// SPDX-License-Identifier: Apache-2.0
#include "server/http/route_docs.h"

#include <algorithm>

#include "server/http/handlers.h"

namespace vitrine {
namespace {

constexpr std::string_view kBytes = "application/octet-stream";
constexpr std::string_view kLevel = "triangles error bytes level kbps seconds saveData";

// A line a route; what it does for whom is in the schemas.
constexpr RouteDoc kDocs[] = {
    {list_models, "listModels", "The models on display, newest first.", "q limit cursor drafts", "",
     200, "ModelPage"},
    {show_model, "getModel", "What is known about a model.", "", "", 200, "Model"},
    {show_manifest, "getManifest",
     "Levels, regions, chunks, sizes and errors; with a wish, what to expect of it.", kLevel, "",
     200, "Manifest"},
    {show_head, "getHead", "Header and base mesh: all that the first picture needs.", "", "", 200,
     kBytes},
    {show_file, "getFile", "The whole .pmesh file.", "", "", 200, kBytes},
    {show_chunk, "getChunk", "A layer or a base mesh by its hash; it never changes.", "", "", 200,
     kBytes},
    {show_model_chunk, "getChunkOfModel", "The same of a draft, too, and for no cache to keep.", "",
     "", 200, kBytes},
    {open_stream, "openStream",
     "Goes on as a WebSocket of the subprotocol pmesh.v1 (server/stream/PROTOCOL.md).", "", "", 101,
     ""},
    {export_model, "exportModel",
     "A level of detail as a file: glb, ply, obj, stl, drc or wrl. All of it where nothing is "
     "said.",
     kLevel, "", 200, kBytes},
    {show_poster, "getPoster",
     "A square picture of the model, from where the viewer shows it at first; transparent around "
     "it.",
     "width", "", 200, "image/png"},
    {show_iiif_manifest, "getIiifManifest",
     "IIIF Presentation 3.0: a canvas with the poster, the model as its rendering.", "", "", 200,
     "IiifManifest"},
    {show_oembed, "getOembed", "How another site embeds the page of a model (oEmbed 1.0).",
     "url maxwidth maxheight format", "", 200, "Oembed"},
    {show_openapi, "getOpenapi", "This document.", "", "", 200, "OpenapiDocument"},
    {make_model, "makeModel", "Makes a model of an upload, or puts it in the place of another.",
     "idempotencyKey", "ModelOrder", 202, "JobStarted"},
    {change_model, "changeModel", "Changes what is known about a model, and how much is public.",
     "ifMatch", "ModelChange", 200, "Model"},
    {remove_model, "removeModel", "Takes a model away for good.", "ifMatch", "", 204, ""},
    {publish_model, "publishModel", "Shows a draft to everybody.", "", "", 200, "Model"},
    {unpublish_model, "unpublishModel", "Makes a model a draft again.", "", "", 200, "Model"},
    {list_scanners, "listScanners",
     "The scanners and their devices; unreachable are those whose daemon does not answer, too.", "",
     "", 200, "ScannerList"},
    {show_scanner, "getScanner", "A scanner and its devices.", "", "", 200, "Scanner"},
    {jog_scanner, "jogScanner", "Turns the table by hand.", "", "Jog", 200, "Scanner"},
    {switch_laser, "switchLaser", "Switches the laser by hand.", "", "LaserSwitch", 200, "Scanner"},
    {stop_scanner, "stopScanner",
     "Emergency stop: laser and motor off at once, whatever the body is.", "", "", 200, "Scanner"},
    {show_preview, "getPreview", "A picture of what the camera sees.", "", "", 200, "image/png"},
    {list_calibrations, "listCalibrations", "A scanner's calibrations, newest first.", "", "", 200,
     "CalibrationList"},
    {start_calibration, "startCalibration", "Begins a calibration.", "idempotencyKey",
     "CalibrationOrder", 202, "JobStarted"},
    {show_calibration, "getCalibration", "The report of a calibration.", "", "", 200,
     "CalibrationReport"},
    {show_residuals, "getResiduals", "A plot of a calibration's residuals.", "", "", 200,
     "image/svg+xml"},
    {list_scans, "listScans", "The scans, newest first.", "limit cursor", "", 200, "ScanPage"},
    {start_scan, "startScan", "Begins a scan, which becomes a draft or a published model.",
     "idempotencyKey", "ScanOrder", 202, "ScanStarted"},
    {show_scan, "getScan", "How far a scan is.", "", "", 200, "Scan"},
    {show_points, "getPoints",
     "The points measured so far: x, y and z in mm as little-endian float32.", "from", "", 200,
     kBytes},
    {show_profile, "getProfile", "The latest profile.", "", "", 200, "Profile"},
    {pause_scan, "pauseScan", "Pauses a scan at its next step.", "", "Nothing", 202, "Scan"},
    {resume_scan, "resumeScan", "Goes on with a scan that is paused, interrupted or failed.", "",
     "Nothing", 202, "Scan"},
    {reprocess_scan, "reprocessScan", "Makes a model of a scan anew.", "idempotencyKey",
     "ReprocessOrder", 202, "ScanStarted"},
    {list_jobs, "listJobs", "The jobs, newest first.", "limit cursor", "", 200, "JobPage"},
    {show_job, "getJob", "How far a job is.", "", "", 200, "Job"},
    {cancel_job, "cancelJob", "Cancels a job at its next step.", "", "", 202, "Job"},
    {resume_job, "resumeJob", "Goes on with a job that is paused, interrupted or failed.", "",
     "Nothing", 202, "Job"},
    {create_upload, "createUpload",
     "Begins a resumable upload (tus 1.0.0); a body of the type of pieces is its first one.",
     "tusResumable uploadLength uploadMetadata", "", 201, ""},
    {show_upload, "getUpload", "How much of an upload has come; HEAD tells it in Upload-Offset.",
     "", "", 200, "Upload"},
    {append_to_upload, "appendToUpload",
     "The next piece of an upload; durable once it is answered.", "tusResumable uploadOffset",
     "application/offset+octet-stream", 204, ""},
    {remove_upload, "removeUpload", "Gives an upload up.", "tusResumable", "", 204, ""},
    {list_tokens, "listTokens", "The tokens in force, oldest first.", "limit cursor", "", 200,
     "TokenPage"},
    {add_token, "addToken", "Makes a token; its text is shown once.", "", "TokenOrder", 201,
     "NewToken"},
    {revoke_token, "revokeToken",
     "Makes a token worthless: here at once, at other daemons of the installation within 100 ms.",
     "", "", 204, ""},
    {show_job_events, "followJob",
     "Server-sent events `job`, each with the job as it is then, until it has ended.", "", "", 200,
     "text/event-stream"},
};

}  // namespace

std::span<const RouteDoc> route_docs() {
  return kDocs;
}

const RouteDoc* find_doc(Handler handler) {
  const auto* found = std::ranges::find(kDocs, handler, &RouteDoc::handler);
  return found == std::end(kDocs) ? nullptr : found;
}

}  // namespace vitrine
