// A stand-in for the editor's module `vscode`: enough for vscode-languageclient to run in plain Node.
//
// What the client registers is kept: `providers` by kind, `diagnostics` by document. `fire` plays the editor's part.
"use strict";

const { pathToFileURL } = require("node:url");

class Position {
  constructor(line, character) {
    Object.assign(this, { line, character });
  }
}

class Range {
  constructor(startLine, startCharacter, endLine, endCharacter) {
    const places = startLine instanceof Position;
    this.start = places ? startLine : new Position(startLine, startCharacter);
    this.end = places ? startCharacter : new Position(endLine, endCharacter);
  }
}

class Uri {
  constructor(text) {
    this.text = text;
    this.scheme = text.slice(0, text.indexOf(":"));
    this.fsPath = this.path = text.slice(this.scheme.length + 1);
  }

  static parse(text) {
    return new Uri(text);
  }

  static file(path) {
    return new Uri(pathToFileURL(path).href);
  }

  toString() {
    return this.text;
  }
}

class EventEmitter {
  constructor() {
    this.listeners = new Set();
    this.event = (run, self, list) => {
      const listener = self === undefined ? run : run.bind(self);
      this.listeners.add(listener);
      const stop = { dispose: () => this.listeners.delete(listener) };
      if (Array.isArray(list)) list.push(stop);
      return stop;
    };
  }

  fire(value) {
    return Promise.all([...this.listeners].map((run) => run(value)));
  }

  dispose() {
    this.listeners.clear();
  }
}

class CancellationTokenSource {
  constructor() {
    this.emitter = new EventEmitter();
    this.token = { isCancellationRequested: false, onCancellationRequested: this.emitter.event };
  }

  dispose() {}
}

class Record {
  constructor(...values) {
    this.values = values;
  }

  dispose() {}
}

class Diagnostic {
  constructor(range, message, severity) {
    Object.assign(this, { range, message, severity });
  }
}

class Hover {
  constructor(contents) {
    this.contents = [contents].flat();
  }
}

class MarkdownString {
  constructor(value = "") {
    this.value = value;
  }
}

class Location {
  constructor(uri, range) {
    Object.assign(this, { uri, range });
  }
}

class CodeActionKind {
  constructor(value) {
    this.value = value;
  }

  append(part) {
    return new CodeActionKind(this.value === "" ? part : `${this.value}.${part}`);
  }
}

for (const [name, value] of Object.entries({ Empty: "", QuickFix: "quickfix", Refactor: "refactor", Source: "source" })) {
  CodeActionKind[name] = new CodeActionKind(value);
}

// Anything that is not spelt out: classes that hold what they are given, enumerations and events without effect.
function loose(known) {
  return new Proxy(known, {
    get(target, key) {
      if (!(key in target) && typeof key === "string") {
        if (key.startsWith("on")) target[key] = new EventEmitter().event;
        else if (key.startsWith("register") || key.startsWith("create")) target[key] = () => new Record();
        else target[key] = class extends Record {};
      }
      return target[key];
    },
  });
}

function standIn(settings) {
  const providers = {};
  const diagnostics = new Map();
  const published = new EventEmitter();
  const events = { open: new EventEmitter(), change: new EventEmitter(), close: new EventEmitter() };
  const register = (kind) => (selector, provider) => {
    providers[kind] = provider;
    return new Record();
  };
  const kinds = "Hover Definition Reference Rename DocumentSymbol FoldingRange InlayHints CodeLens CodeActions".split(" ");
  const languages = Object.fromEntries(kinds.map((kind) => [`register${kind}Provider`, register(kind)]));
  languages.registerCompletionItemProvider = register("Completion");
  languages.match = (selector, document) => Number([selector].flat().some((one) => one.language === document.languageId));
  languages.createDiagnosticCollection = () => ({
    set(uri, found) {
      diagnostics.set(uri.toString(), found || []);
      published.fire(uri.toString());
    },
    delete: (uri) => diagnostics.delete(uri.toString()),
    clear: () => diagnostics.clear(),
    dispose() {},
  });
  const output = { append: (text) => process.stderr.write(text), appendLine() {}, show() {}, dispose() {} };
  const documents = [];
  const messages = [];
  const commands = {};
  const status = { text: "", show() {}, dispose() {} };
  const vscode = loose({
    Position, Range, Uri, EventEmitter, CancellationTokenSource, Diagnostic, Hover, MarkdownString, Location, CodeActionKind,
    Disposable: Record,
    version: "1.91.0",
    env: loose({ appName: "stand-in", language: "en", clipboard: {} }),
    languages: loose(languages),
    workspace: loose({
      textDocuments: documents,
      notebookDocuments: [],
      workspaceFolders: undefined,
      getConfiguration: () => ({ get: (key, otherwise) => settings[key] ?? otherwise, inspect: () => undefined }),
      onDidOpenTextDocument: events.open.event,
      onDidChangeTextDocument: events.change.event,
      onDidCloseTextDocument: events.close.event,
    }),
    window: loose({
      visibleTextEditors: [],
      activeTextEditor: undefined,
      tabGroups: loose({ all: [] }),
      createStatusBarItem: () => status,
      createOutputChannel: () => output,
      showErrorMessage: async (text) => void messages.push(text),
    }),
    commands: loose({
      registerCommand: (name, run) => {
        commands[name] = run;
        return new Record();
      },
    }),
  });
  return { vscode, providers, diagnostics, published, events, documents, messages, commands, status };
}

// A document of the editor.
class Document {
  constructor(uri, text) {
    Object.assign(this, { uri: Uri.parse(uri), fileName: uri, languageId: "din66025", version: 1, text, isClosed: false });
  }

  getText() {
    return this.text;
  }
}

module.exports = { CancellationTokenSource, Document, Position, Range, standIn };
