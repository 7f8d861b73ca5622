#include "plugin/paraview/client/scan/archive_dialog.h"

#include <QCheckBox>
#include <QDialogButtonBox>
#include <QFileDialog>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QLineEdit>
#include <QPushButton>
#include <QSpinBox>
#include <QToolButton>

#include <algorithm>
#include <chrono>
#include <exception>
#include <filesystem>
#include <string>

#include "plugin/app/archive_settings.h"
#include "plugin/messages/messages.h"
#include "plugin/paraview/client/scan/archive_words.h"
#include "plugin/paraview/client/widgets/message_label.h"
#include "plugin/paraview/client/words.h"

namespace palpate::plugin {

double echo_ms(const io::Archive& archive) {
  const auto begin = std::chrono::steady_clock::now();
  io::echo(archive);
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

ArchiveDialog::ArchiveDialog(Job& echoing, QWidget* parent) : QDialog(parent), echoing_(echoing) {
  setObjectName(QStringLiteral("palpateArchiveDialog"));
  setWindowTitle(tr("Add an archive"));
  auto* const form = new QFormLayout(this);
  const auto line = [&](const char* name, const QString& label, const QString& tip) {
    auto* const field = new QLineEdit(this);
    field->setObjectName(QString::fromLatin1(name));
    field->setToolTip(tip);
    form->addRow(label, field);
    return field;
  };
  const auto port = [&](const char* name, const QString& label, int at_first, const QString& tip) {
    auto* const field = new QSpinBox(this);
    field->setObjectName(QString::fromLatin1(name));
    field->setRange(1, 65535);
    field->setValue(at_first);
    field->setToolTip(tip);
    form->addRow(label, field);
    return field;
  };
  const io::Archive defaults;
  name_ = line("palpateArchiveName", tr("Name"), tr("The name of the archive in this program"));
  host_ = line("palpateArchiveHost", label_of("--host"), tr("The name or address of the archive's machine"));
  port_ = port("palpateArchivePort", label_of("--port"), defaults.port, tr("Its DICOM port"));
  called_ = line("palpateArchiveCalled", label_of("--called"), tr("The archive's AE title (ask its administrator)"));
  calling_ = line("palpateArchiveCalling", label_of("--calling"),
                  tr("The AE title of this program; the archive has to know it"));
  uses_get_ = new QCheckBox(label_of("--get"), this);
  uses_get_->setObjectName(QStringLiteral("palpateArchiveGet"));
  uses_get_->setToolTip(
      tr("With C-GET the archive answers on our connection. Without it, the archive connects to our port (C-MOVE)."));
  form->addRow(QString(), uses_get_);
  listen_ = port("palpateArchiveListen", label_of("--listen"), defaults.listen_port,
                 tr("For C-MOVE: the archive must know this port, our AE title and this machine's address"));
  connect(uses_get_, &QCheckBox::toggled, listen_, &QSpinBox::setDisabled);
  build_tls(*form);
  message_ = make_message_label(*this, "palpateArchiveDialogMessage");
  constexpr int wide = 380;
  message_->setMinimumWidth(wide);
  form->addRow(message_);
  auto* const buttons = new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Cancel, this);
  QPushButton* const echo = buttons->addButton(tr("Echo"), QDialogButtonBox::ActionRole);
  echo->setObjectName(QStringLiteral("palpateArchiveEcho"));
  echo->setToolTip(tr("Tests whether the archive answers and accepts our AE title (C-ECHO)"));
  buttons->button(QDialogButtonBox::Ok)->setObjectName(QStringLiteral("palpateArchiveOk"));
  connect(echo, &QPushButton::clicked, this, [this] { this->echo(); });
  connect(buttons, &QDialogButtonBox::accepted, this, &ArchiveDialog::accept);
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  form->addRow(buttons);
}

/// Certificates and a key, each a file in PEM. Where none is named the connection is not encrypted.
void ArchiveDialog::build_tls(QFormLayout& form) {
  const auto file = [&](const char* name, const QString& label, const QString& tip) {
    auto* const row = new QHBoxLayout;
    auto* const field = new QLineEdit(this);
    field->setObjectName(QString::fromLatin1(name));
    field->setToolTip(tip);
    row->addWidget(field, 1);
    auto* const browse = new QToolButton(this);
    browse->setObjectName(QString::fromLatin1(name) + QStringLiteral("Browse"));
    browse->setText(tr("…"));
    browse->setToolTip(tip);
    connect(browse, &QToolButton::clicked, this, [this, field, label] {
      const QString chosen = QFileDialog::getOpenFileName(
          this, label, field->text(), tr("Certificates and keys (*.pem *.crt *.cer *.key);;All files (*)"));
      if (!chosen.isEmpty()) field->setText(chosen);
    });
    row->addWidget(browse);
    form.addRow(label, row);
    return field;
  };
  authorities_ =
      file("palpateArchiveTlsCa", label_of("--tls-ca"),
           tr("The certificate (PEM) of the authority that signed the archive's certificate. Empty: no TLS."));
  certificate_ = file("palpateArchiveTlsCertificate", label_of("--tls-certificate"),
                      tr("Our own certificate (PEM). It is needed if the archive asks for one, and for C-MOVE."));
  key_ = file("palpateArchiveTlsKey", label_of("--tls-key"),
              tr("The private key of our certificate (PEM), without a pass phrase"));
  tls_name_ = new QLineEdit(this);
  tls_name_->setObjectName(QStringLiteral("palpateArchiveTlsName"));
  tls_name_->setToolTip(tr("The host name in the archive's certificate, if it differs from the host above"));
  form.addRow(label_of("--tls-name"), tls_name_);
  // The settings of an archive with that name are shown, and can be changed.
  connect(name_, &QLineEdit::editingFinished, this, [this] { show_tls(); });
}

void ArchiveDialog::show_tls() {
  io::Tls tls;
  try {
    for (const io::Archive& entered : read_archives()) {
      if (entered.name == name().toStdString()) tls = entered.tls;
    }
  } catch (const std::exception& error) {
    tell(QString::fromUtf8(error.what()), true);
    return;
  }
  if (!tls.used) return;
  const auto show = [](QLineEdit& field, const std::string& text) {
    if (field.text().isEmpty()) field.setText(QString::fromStdString(text));
  };
  show(*authorities_, tls.authorities.string());
  show(*certificate_, tls.certificate.string());
  show(*key_, tls.key.string());
  show(*tls_name_, tls.name);
}

io::Tls ArchiveDialog::tls() const {
  const auto file = [](const QLineEdit& field) {
    const std::string text = field.text().trimmed().toStdString();
    return text.empty() ? std::filesystem::path() : std::filesystem::absolute(text);
  };
  io::Tls tls{.authorities = file(*authorities_),
              .certificate = file(*certificate_),
              .key = file(*key_),
              .name = tls_name_->text().trimmed().toStdString()};
  tls.used = !tls.authorities.empty() || !tls.certificate.empty() || !tls.key.empty();
  return tls;
}

ArchiveDialog::~ArchiveDialog() {
  echoing_.cancel();
}

QString ArchiveDialog::name() const {
  return name_->text().trimmed();
}

/// Settings that the dialog does not show (time-outs, our address) stay as entered on the command line.
io::Archive ArchiveDialog::archive() const {
  io::Archive archive;
  for (const io::Archive& entered : read_archives()) {
    if (entered.name == name().toStdString()) archive = entered;
  }
  archive.name = name().toStdString();
  archive.host = host_->text().trimmed().toStdString();
  archive.port = port_->value();
  archive.called = called_->text().trimmed().toStdString();
  archive.calling = calling_->text().trimmed().toStdString();
  archive.uses_get = uses_get_->isChecked();
  archive.listen_port = listen_->value();
  archive.tls = tls();
  return archive;
}

/// All of it is seen: the dialog grows with it.
void ArchiveDialog::tell(const QString& message, bool problem) {
  set_message(*message_, in_fields(message), problem);
  message_->setMinimumHeight(message_->heightForWidth(message_->width()));
  layout()->activate();
  if (height() < minimumSizeHint().height()) resize(width(), minimumSizeHint().height());
}

void ArchiveDialog::echo() {
  try {
    const io::Archive asked = archive();
    io::check(asked);
    tell(words(say("archive-is-asked", asked.name)), false);
    echoing_.ask([asked](const auto& /*job*/) { return echo_ms(asked); },
                 [this, asked](const auto& ms, const QString& error) {
                   tell(ms ? words(say("archive-answers", asked.name, asked.calling, static_cast<int>(*ms))) : error,
                        !ms);
                 });
  } catch (const std::exception& error) {
    tell(QString::fromUtf8(error.what()), true);
  }
}

void ArchiveDialog::accept() {
  try {
    const io::Archive entered = archive();
    if (entered.name.empty()) {
      tell(words(say("archive-needs-a-name")), true);
      return;
    }
    io::check(entered);
    std::vector<io::Archive> all = read_archives();
    std::erase_if(all, [&](const io::Archive& other) { return other.name == entered.name; });
    all.push_back(entered);
    write_archives(all);
  } catch (const std::exception& error) {
    tell(QString::fromUtf8(error.what()), true);
    return;
  }
  QDialog::accept();
}

}  // namespace palpate::plugin
