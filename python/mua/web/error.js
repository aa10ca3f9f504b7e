// The one error that a user may see: a sentence that names file, field and what is wrong.

export class AvatarError extends Error {
  /**
   * @param {string} sentence for the user, whole
   * @param {{code?: string, field?: string}} [where] code and field of a file's fault, as in schemas/README.md
   */
  constructor(sentence, { code = "", field = "" } = {}) {
    super(sentence);
    this.name = "AvatarError";
    this.code = code;
    this.field = field;
  }
}
