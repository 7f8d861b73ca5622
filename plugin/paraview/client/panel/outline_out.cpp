#include "plugin/paraview/client/panel/outline_out.h"

#include <utility>

#include "io/fresh_folder.h"
#include "plugin/messages/messages.h"
#include "plugin/paraview/client/words.h"
#include "plugin/paraview/client/words/patient_words.h"

namespace palpate::plugin {
namespace {

constexpr int whole = 100;

void write_outline(const CorrectedOutline& outline, const std::filesystem::path& file, io::StructureForm form,
                   bool overwrite, const io::Progress& progress) {
  const io::SignedDistance distance = [&](const io::Vec3& at) { return outline.distance->sample(at).mm; };
  io::write_structure(io::label_of(outline.structure), outline.series, outline.scan->geometry, distance, {}, form, file,
                      {.overwrite = overwrite, .software_version = PALPATE_VERSION, .frame = outline.frame}, progress);
}

}  // namespace

OutlineOut::OutlineOut(QWidget* parent) : WorkBar(QStringLiteral("palpateOutlineOut"), parent) {}

void OutlineOut::save(const CorrectedOutline& outline, const std::filesystem::path& file, bool as_contours,
                      bool overwrite, std::function<void()> done) {
  set_patient(patient_in_words(outline.series.identity.patient_name));
  const auto work = [this, outline, file, as_contours, overwrite](const Job::Control& job) -> Said {
    const io::StructureForm form = io::form_of(file, as_contours);
    write_outline(outline, file, form, overwrite, [&](double part) {
      tell_progress(job, static_cast<int>(whole * part), whole);
      return job.keep_going();
    });
    return {words(say("outline-is-written", file.string()))};
  };
  begin(tr("Writing %p%"), work, std::move(done));
}

void OutlineOut::send(const CorrectedOutline& outline, const io::Archive& archive, std::function<void()> done) {
  set_patient(patient_in_words(outline.series.identity.patient_name));
  const auto work = [outline, archive](const Job::Control& job) -> Said {
    const io::FreshFolder folder = io::temporary_folder();
    const std::filesystem::path file = folder.path() / "outline.dcm";
    write_outline(outline, file, io::StructureForm::segmentation, false, [&](double) { return job.keep_going(); });
    const io::Sent sent = io::send(archive, {file}, [&](std::size_t) { return job.keep_going(); });
    if (!sent.not_sent.empty()) return {words(sent.not_sent.front().why), true};
    return {words(say("outline-is-sent", archive.name))};
  };
  begin(tr("Sending"), work, std::move(done));
}

}  // namespace palpate::plugin
