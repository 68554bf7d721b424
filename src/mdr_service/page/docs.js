// An SVG response is shown as a picture; Swagger UI shows its text.
const pictures = (system) => ({
  wrapComponents: {
    responseBody: (Original) => (props) => {
      const { createElement } = system.React;
      if (!props.contentType?.startsWith("image/svg+xml")) return createElement(Original, props);
      const source = `data:image/svg+xml,${encodeURIComponent(props.content)}`;
      return createElement("img", { src: source, alt: "Response as a picture", className: "picture" });
    },
  },
});

SwaggerUIBundle({
  url: "openapi.json",
  dom_id: "#swagger-ui",
  deepLinking: true,
  displayRequestDuration: true,
  // The models are shown with the requests that use them.
  defaultModelsExpandDepth: -1,
  // Swagger UI would send the document to a validator on another host.
  validatorUrl: null,
  plugins: [pictures],
});
