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

/** Any error as one that a user may see. @param {unknown} error @param {string} what cannot be done */
export function asAvatarError(error, what) {
  return error instanceof AvatarError
    ? error
    : new AvatarError(`${what}: ${error instanceof Error ? error.message : error}`);
}

/** Of a module that does not come when it is asked for. @param {string} what cannot be done @returns {(error: unknown) => never} */
export const unfetched = (what) => (error) => {
  throw asAvatarError(error, what);
};
