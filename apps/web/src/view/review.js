// Asks the program for the report on the recording that is shown, and saves it.
export function addReview(button, program, title, onMessage) {
  button.hidden = false;
  button.addEventListener("click", async () => {
    button.disabled = true;
    onMessage("Making the report …");
    try {
      const link = document.createElement("a");
      link.href = URL.createObjectURL(await program.review());
      link.download = `${title.replace(/\.[^.]*$/, "")}.review.html`;
      link.click();
      URL.revokeObjectURL(link.href);
      onMessage("");
    } catch (error) {
      onMessage(error.message);
    } finally {
      button.disabled = false;
    }
  });
}
